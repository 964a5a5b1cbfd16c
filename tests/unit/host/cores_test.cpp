/// The share of the processor that control groups grant, from trees of files as containers see them.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "host/process/cores.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

class CpuQuotaTest : public testing::Test {
 protected:
  CpuQuotaTest() { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  void mounts(const std::string& text) const { write("proc/self/mountinfo", text); }
  void paths(const std::string& text) const { write("proc/self/cgroup", text); }
  [[nodiscard]] double quota() const { return cpu_quota(root_).value_or(-1); }

  fs::path root_ = fs::current_path() / "fake_root";
};

constexpr const char*
    unified_mount = "30 23 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate\n";
constexpr const char* cpu_mount = "33 32 0:30 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n";

TEST_F(CpuQuotaTest, NoFilesSetNoLimit) { EXPECT_FALSE(cpu_quota(root_)); }

TEST_F(CpuQuotaTest, Version2InItsOwnNamespace) {
  mounts(unified_mount);
  paths("0::/\n");
  write("sys/fs/cgroup/cpu.max", "150000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 1.5);
  write("sys/fs/cgroup/cpu.max", "max 100000\n");
  EXPECT_FALSE(cpu_quota(root_));
}

TEST_F(CpuQuotaTest, TheSmallestLimitOfNestedGroupsCounts) {
  mounts(unified_mount);
  paths("0::/user.slice/job_7/step\n");
  write("sys/fs/cgroup/user.slice/cpu.max", "800000 100000\n");
  write("sys/fs/cgroup/user.slice/job_7/cpu.max", "200000 100000\n");
  write("sys/fs/cgroup/user.slice/job_7/step/cpu.max", "max 100000\n");
  write("sys/fs/cgroup/user.slice/other/cpu.max", "10000 100000\n");
  EXPECT_DOUBLE_EQ(quota(), 2.0);
}

TEST_F(CpuQuotaTest, Version1) {
  mounts(cpu_mount);
  paths("5:memory:/m\n4:cpu,cpuacct:/docker/ab12\n");
  write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  EXPECT_FALSE(cpu_quota(root_));
  write("sys/fs/cgroup/cpu,cpuacct/docker/ab12/cpu.cfs_quota_us", "50000\n");
  write("sys/fs/cgroup/cpu,cpuacct/docker/ab12/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(quota(), 0.5);
}

TEST_F(CpuQuotaTest, AContainerSeesItsGroupAsTheRootOfTheMount) {
  mounts("33 32 0:30 /docker/ab12 /sys/fs/cgroup/cpu ro - cgroup cgroup rw,cpu\n");
  paths("4:cpu:/docker/ab12/inner\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "300000\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(quota(), 3.0);
  write("sys/fs/cgroup/cpu/inner/cpu.cfs_quota_us", "250000\n");
  write("sys/fs/cgroup/cpu/inner/cpu.cfs_period_us", "100000\n");
  EXPECT_DOUBLE_EQ(quota(), 2.5);
  paths("4:cpu:/elsewhere\n");  // a group above the container, of which nothing is seen
  EXPECT_DOUBLE_EQ(quota(), 3.0);
}

TEST_F(CpuQuotaTest, BothVersionsAtOnce) {
  mounts(std::string(cpu_mount) + "34 32 0:31 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  paths("4:cpu,cpuacct:/a\n0::/b\n");
  write("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "400000\n");
  write("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000\n");
  write("sys/fs/cgroup/unified/b/cpu.max", "100000 50000\n");
  EXPECT_DOUBLE_EQ(quota(), 2.0);
}

TEST_F(CpuQuotaTest, FilesThatHoldSomethingElseSetNoLimit) {
  mounts(unified_mount);
  paths("garbage\n0::/\n");
  for (const char* text : {"", "100000", "0 100000", "-5 100000", "100000 0", "many few", "1e999 1"}) {
    write("sys/fs/cgroup/cpu.max", text);
    EXPECT_FALSE(cpu_quota(root_)) << text;
  }
}

TEST(CoresTest, APartOfACoreCountsAsOne) {
  EXPECT_EQ((Cores{8, 4, {}}.usable()), 4);
  EXPECT_EQ((Cores{8, 4, 1.5}.usable()), 2);
  EXPECT_EQ((Cores{8, 4, 0.1}.usable()), 1);
  EXPECT_EQ((Cores{8, 4, 6.0}.usable()), 4);
}

TEST(CoresTest, TheTextSaysWhatLimits) {
  EXPECT_EQ((Cores{8, 8, {}}.text()), "8 cores are available");
  EXPECT_EQ((Cores{8, 4, 1.5}.text()),
            "2 cores are available (the machine has 8, the process may run on 4, its control group grants 1.5)");
  EXPECT_EQ((Cores{8, 1, {}}.text()), "1 core is available (the machine has 8, the process may run on 1)");
}

TEST(CoresTest, ThisProcessHasACore) {
  const Cores cores = cores_of_this_process();
  EXPECT_GE(cores.usable(), 1);
  EXPECT_GE(cores.machine, cores.allowed);
}

}  // namespace
}  // namespace voussoir::host
