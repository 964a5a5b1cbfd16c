#!/usr/bin/env python3
"""Counts what one particle-step of the GPU engine costs, from its compiled code and a packing: registers, spills, fast
memory, blocks that share a multiprocessor, instructions of the loop of steps, wavefronts of shared memory, and from these
an estimate of the rate on an H100. Needs nvcc and Kokkos for CUDA (tools/setup --cuda) and no GPU.

    tools/count_kernel.py [--precision float|double] [--plan Small|Middle|Large] [--packing FILE]
    tools/count_kernel.py --check

--check compares the plan Middle in float with the counts that were written down here and exits with 1 where they differ, with 77
where nvcc or a tool that reads machine code is missing."""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import step_wavefronts

ROOT = Path(__file__).resolve().parent.parent
PREFIX = ROOT / ".prefix"
PACKING = ROOT / "tests/data/packings/cps_d_150_particles.csv"
SKIN = 0.08  # of the lists, over the mean diameter: the default of engine.skin
# An H100 SXM. Registers and shared memory of compute capability 9.0; each block takes 1 KiB more than it asks for.
MULTIPROCESSORS, CLOCK, ISSUED_A_CYCLE = 132, 1.98e9, 4
REGISTERS_OF_SM, FAST_OF_SM, RESERVED, THREADS_OF_SM = 65536, 227 * 1024, 1024, 2048
# What the prototype's variants used of the data stage of L1 and of the issue slots (docs/measurements/gpu.md): 70 % and 53 %
# as it was designed, with 16 warps and a branch on touching like this kernel; 91 % and 67 % at best.
DESIGNED, BEST = (0.70, 0.53), (0.91, 0.67)
TEAM_INSTRUCTIONS, TEAM_WAVEFRONTS = 17.4, 28.7  # of a particle-step of the team kernel that this engine replaced
# The plan Middle in float, as it is compiled by CUDA 13.0 for sm_90.
EXPECTED_INSTRUCTIONS, EXPECTED_FAST, EXPECTED_BLOCKS = 1099, 80880, 2

KERNEL = """
#include "kernels/device/cuda/cuda_backend.hpp"
using namespace voussoir::kernels;
using Law = EngineLaw<SingleLane<{real}>, true>;
template __global__ void device::advance_kernel<Law, StrainDrive, device::{plan}Plan, false>(
    const __grid_constant__ device::BlockBatch<{real}, StrainDrive>, const __grid_constant__ EngineSettings, const int,
    char*, const std::size_t);
"""
SIZES = """
#include "kernels/device/block_run.hpp"
#include <cstdio>
using namespace voussoir::kernels;
int main() {{
  using Plan = device::BlockPlan<{pair_slots}, {grain_slots}>;
  using Memory = device::BlockMemory<EngineLaw<SingleLane<{real}>, true>, StrainDrive, Plan>;
  const Memory sizes(device::no_memory(), device::no_memory(), {threads} * {grain_slots}, {threads} * {pair_slots}, {threads});
  std::printf("%zu %zu\\n", sizes.fast_bytes, sizes.slow_bytes);
}}
"""


class Missing(Exception):
    """A tool is not there."""


@dataclass
class Plan:
    threads: int
    blocks: int
    pair_slots: int
    grain_slots: int


@dataclass
class Compiled:
    registers: int
    stack: int
    spilled: int
    fast: int
    slow: int
    blocks: int  # on a multiprocessor


@dataclass
class Loop:
    """Instructions of the loop of steps by its parts."""

    pairs: list  # of all slots of a thread
    cell: list  # one warp a block carries the cell on
    grain: list  # of one grain, without those of its pairs
    turn: list  # of one pair of a grain

    @property
    def all(self):
        return self.pairs + self.cell + self.grain + self.turn


def found_in(pattern, text):
    """The first group of a pattern that must be in a text."""
    found = re.search(pattern, text)
    if found is None:
        sys.exit(f"{pattern} is not in what was read")
    return found.group(1)


def plan_of(name):
    text = (ROOT / "kernels/device/cuda/cuda_backend.hpp").read_text()
    return Plan(*(int(x) for x in found_in(rf"using {name}Plan = CudaPlan<([\d, ]+)>", text).split(",")))


def tool(name):
    """CUDA's own program, or that of the Python package."""
    path = os.environ["PATH"] + os.pathsep + os.environ.get("CUDA_HOME", "/usr/local/cuda") + "/bin"
    own = shutil.which(name, path=path)
    if own:
        return own
    for file in sorted(PREFIX.glob(f"venv/lib/python*/site-packages/nvidia/*/bin/{name}")):
        return str(file)
    raise Missing(f"there is no {name}")


def compile_kernel(precision, plan, folder):
    """Returns the object file and what ptxas says of the kernel: registers, bytes of stack, spilled bytes."""
    nvcc = Path(tool("nvcc"))
    kokkos = PREFIX / "kokkos-cuda"
    if not (kokkos / "bin/nvcc_wrapper").exists():
        raise Missing("there is no Kokkos for CUDA (tools/setup --cuda)")
    source, target = folder / "kernel.cpp", folder / "kernel.o"
    source.write_text(KERNEL.format(real=precision, plan=plan))
    words = [kokkos / "bin/nvcc_wrapper", "-arch=sm_90", "-include", ROOT / "tools/cuda/kokkos_cuda13.hpp"]
    words += ["-std=c++20", "-O3", "--use_fast_math", "-fmad=false", f"-I{ROOT}", f"-I{kokkos / 'include'}"]
    words += ["-Xptxas", "-v", "-c", source, "-o", target]
    environment = os.environ | {"PATH": f"{nvcc.parent}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run([str(w) for w in words], check=False, capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        sys.exit(f"the kernel does not compile:\n{done.stderr[-2000:]}")
    lines = done.stderr.splitlines()
    at = next(k for k, line in enumerate(lines) if "Function properties" in line and "advance_kernel" in line)
    numbers = [int(x) for x in re.findall(r"(\d+) bytes", lines[at + 1])]
    registers = int(found_in(r"Used (\d+) registers", " ".join(lines[at : at + 4])))
    return target, registers, numbers[0], numbers[1] + numbers[2]


def memory_of(precision, plan, folder):
    """Bytes of fast and of slow memory of a block."""
    source, target = folder / "sizes.cpp", folder / "sizes"
    source.write_text(SIZES.format(real=precision, **vars(plan)))
    kokkos = PREFIX / "kokkos"
    words = ["g++", "-std=c++20", "-O1", "-fopenmp", f"-I{ROOT}", f"-I{kokkos / 'include'}", source]
    words += [kokkos / "lib/libkokkoscore.a", "-ldl", "-o", target]
    subprocess.run([str(w) for w in words], check=True)
    out = subprocess.run([str(target)], check=True, capture_output=True, text=True).stdout
    return [int(x) for x in out.split()]


def compiled(precision, name, folder):
    plan = plan_of(name)
    target, registers, stack, spilled = compile_kernel(precision, name, folder)
    fast, slow = memory_of(precision, plan, folder)
    rounded = (registers + 7) // 8 * 8  # registers are granted by eights
    blocks = min(
        REGISTERS_OF_SM // (rounded * plan.threads), FAST_OF_SM // (fast + RESERVED), THREADS_OF_SM // plan.threads
    )
    return target, Compiled(registers, stack, spilled, fast, slow, blocks)


def machine_code(target):
    """Addresses and texts of the kernel's instructions."""
    environment = os.environ | {"PATH": f"{Path(tool('nvdisasm')).parent}{os.pathsep}{os.environ['PATH']}"}
    words = [tool("cuobjdump"), "-sass", str(target)]
    text = subprocess.run(words, check=True, capture_output=True, text=True, env=environment).stdout
    out, inside = [], False
    for line in text.splitlines():
        if "Function :" in line:
            inside = "advance_kernel" in line
        found = re.match(r"\s+/\*([0-9a-f]{4,6})\*/\s+(.*?);", line)
        if inside and found:
            out.append((int(found.group(1), 16), found.group(2)))
    return out


def kind(text):
    return re.sub(r"^@!?U?P\w+\s+", "", text).split()[0].split(".")[0]


def backward_branches(code):
    """First and last index of each loop: the places of a branch to an earlier address, and of that address."""
    place = {address: k for k, (address, _) in enumerate(code)}
    for k, (address, text) in enumerate(code):
        target = re.search(r"\bBRA\b.*?(0x[0-9a-f]+)", text)
        if target and int(target.group(1), 16) < address and int(target.group(1), 16) in place:
            yield place[int(target.group(1), 16)], k


def step_loop(code):
    """The loop of plain steps: the longest one with two barriers and no call."""
    loops = []
    for first, last in backward_branches(code):
        texts = [text for _, text in code[first : last + 1]]
        if sum("BAR.SYNC" in t for t in texts) == 2 and not any("CALL" in t for t in texts):
            loops.append(code[first : last + 1])
    if not loops:
        sys.exit("no loop with two barriers and no call was found in the machine code")
    return max(loops, key=len)
