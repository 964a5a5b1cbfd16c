#!/usr/bin/env python3
"""Counts what one particle-step of the GPU engine costs, from its compiled code: registers, spills, fast memory, blocks
that share a multiprocessor, and instructions of the loop of steps by kind. Needs nvcc (tools/setup --cuda) and no GPU;
instructions are counted where cuobjdump is found (CUDA's own, or the Python package nvidia-cuda-cuobjdump).

    tools/count_kernel.py [--precision float|double] [--plan Small|Middle|Large] [--arch sm_90] [--keep FILE]
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PREFIX = ROOT / ".prefix"
GRAINS = {"Small": 300, "Middle": 700, "Large": 1500}
LISTED, TOUCHING = 2.40, 2.04  # pairs a grain of dense sand at 100 kPa (docs/measurements/gpu.md)
REGISTERS_OF_SM, FAST_OF_SM = 65536, 227 * 1024  # compute capability 9.0

SOURCE = """
#include "kernels/device/cuda/cuda_backend.hpp"
#include <cstdio>
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
  using Memory = device::BlockMemory<EngineLaw<SingleLane<{real}>, true>, StrainDrive, device::BlockPlan<{pairs}, {grains}>>;
  const Memory sizes(device::no_memory(), device::no_memory(), {threads} * {grains}, {threads} * {pairs}, {threads});
  std::printf("%zu %zu\\n", sizes.fast_bytes, sizes.slow_bytes);
}}
"""


def found_in(pattern, text):
    """The first group of a pattern that must be in a text."""
    found = re.search(pattern, text)
    if found is None:
        sys.exit(f"{pattern} is not in what was read")
    return found.group(1)


def plan_of(name):
    """Threads, blocks a multiprocessor, pair slots and grain slots of an instance, from its source."""
    text = (ROOT / "kernels/device/cuda/cuda_backend.hpp").read_text()
    return [int(x) for x in found_in(rf"using {name}Plan = CudaPlan<([\d, ]+)>", text).split(",")]


def find_cuobjdump():
    own = shutil.which("cuobjdump")
    if own:
        return own
    for file in sorted(PREFIX.glob("venv/lib/python*/site-packages/nvidia/*/bin/cuobjdump")):
        return str(file)
    return None


def compile_kernel(args, folder):
    """Returns the object file and what ptxas says of the kernel: registers, bytes of stack, spilled bytes."""
    source, target = folder / "kernel.cpp", folder / "kernel.o"
    source.write_text(SOURCE.format(real=args.precision, plan=args.plan))
    words = [PREFIX / "kokkos-cuda/bin/nvcc_wrapper", f"-arch={args.arch}", "-include", ROOT / "tools/cuda/kokkos_cuda13.hpp"]
    words += ["-std=c++20", "-O3", "--use_fast_math", "-fmad=false", f"-I{ROOT}", f"-I{PREFIX / 'kokkos-cuda/include'}"]
    words += ["-Xptxas", "-v", "-c", source, "-o", target]
    done = subprocess.run([str(w) for w in words], check=False, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"the kernel does not compile:\n{done.stderr[-2000:]}")
    lines = done.stderr.splitlines()
    at = next(k for k, line in enumerate(lines) if "Function properties" in line and "advance_kernel" in line)
    numbers = [int(x) for x in re.findall(r"(\d+) bytes", lines[at + 1])]
    registers = int(found_in(r"Used (\d+) registers", " ".join(lines[at : at + 4])))
    return target, registers, numbers[0], numbers[1] + numbers[2]


def memory_of(args, plan, folder):
    """Bytes of fast and of slow memory of a block."""
    threads, _, pairs, grains = plan
    source, target = folder / "sizes.cpp", folder / "sizes"
    source.write_text(SIZES.format(real=args.precision, pairs=pairs, grains=grains, threads=threads))
    host = PREFIX / "kokkos"
    subprocess.run(["g++", "-std=c++20", "-O1", "-fopenmp", f"-I{ROOT}", f"-I{host / 'include'}", str(source),
                    str(host / "lib/libkokkoscore.a"), "-ldl", "-o", str(target)], check=True)
    return [int(x) for x in subprocess.run([str(target)], check=True, capture_output=True, text=True).stdout.split()]


def instructions(cuobjdump, target):
    """Addresses and texts of the kernel's machine code."""
    text = subprocess.run([cuobjdump, "-sass", str(target)], check=True, capture_output=True, text=True).stdout
    out, inside = [], False
    for line in text.splitlines():
        if "Function :" in line:
            inside = "advance_kernel" in line
        found = re.match(r"\s+/\*([0-9a-f]{4,6})\*/\s+(.*?);", line)
        if inside and found:
            out.append((int(found.group(1), 16), found.group(2)))
    return out


def step_loop(code):
    """The loop of plain steps: the longest one with two barriers and no call."""
    place = {address: k for k, (address, _) in enumerate(code)}
    best = None
    for k, (address, text) in enumerate(code):
        target = re.search(r"\bBRA\b.*?(0x[0-9a-f]+)", text)
        if not target or int(target.group(1), 16) >= address or int(target.group(1), 16) not in place:
            continue
        body = [t for _, t in code[place[int(target.group(1), 16)] : k + 1]]
        if sum("BAR.SYNC" in t for t in body) == 2 and not any("CALL" in t for t in body):
            if best is None or len(body) > len(best):
                best = body
    return best


def kind(text):
    return re.sub(r"^@!?U?P\d+\s+", "", text).split()[0].split(".")[0]


def report_steps(body, plan):
    """Counts of the loop, and what they mean for one particle-step."""
    threads, _, slots, _ = plan
    first = next(k for k, t in enumerate(body) if "BAR.SYNC" in t)
    pairs, grains = body[:first], body[first:]
    counts = Counter(kind(t) for t in body)
    names = ("FFMA", "FMUL", "FADD", "MUFU", "DFMA", "DMUL", "DADD", "LDS", "STS", "LDG", "LDL", "STL", "BRA")
    print(f"loop of steps: {len(body)} instructions ({len(pairs)} for {slots} pairs, {len(grains)} for grains and cell): "
          + ", ".join(f"{n} {counts[n]}" for n in names if counts[n]))
    gather = grains.index(next(t for t in grains if kind(t) == "LDS"))  # a lower bound of what one entry costs
    per_pair = len(pairs) / slots
    entry = 14  # of the loop over a grain's pairs
    per_grain = len(grains) - entry + 2 * LISTED * entry
    total = (LISTED * per_pair + per_grain) / 32
    print(f"about {total:.1f} warp instructions a particle-step ({LISTED} listed pairs a grain); the loop over a grain's pairs "
          f"is taken as {entry} instructions, from instruction {gather} of its part on")
    ideal = 132 * 4 * 1.98e9 / total / 1e9
    print(f"an H100 (132 SM, 4 instructions a cycle, 1.98 GHz) would do {ideal:.0f} G particle-steps/s if it issued always; "
          f"the prototype reached 0.6 of that")
    return counts["LDL"] + counts["STL"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--precision", choices=("float", "double"), default="float")
    parser.add_argument("--plan", choices=tuple(GRAINS), default="Middle")
    parser.add_argument("--arch", default="sm_90")
    parser.add_argument("--no-spills", action="store_true", help="fail where the loop of steps reads or writes local memory")
    args = parser.parse_args()
    os.environ["PATH"] += os.pathsep + os.environ.get("CUDA_HOME", "/usr/local/cuda") + "/bin"
    plan = plan_of(args.plan)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        target, registers, stack, spilled = compile_kernel(args, folder)
        fast, slow = memory_of(args, plan, folder)
        threads = plan[0]
        blocks = min(REGISTERS_OF_SM // (registers * threads), FAST_OF_SM // (fast + 1024), 2048 // threads)
        print(f"{args.plan}, {args.precision}: {threads} threads, up to {threads * plan[3]} grains and {threads * plan[2]} pairs")
        print(f"registers {registers}, stack {stack} bytes, spilled {spilled} bytes (all code); fast memory {fast} bytes, "
              f"memory of the device {slow} bytes a block; {blocks} blocks and {blocks * threads // 32} warps a multiprocessor")
        cuobjdump = find_cuobjdump()
        if cuobjdump is None:
            print("instructions were not counted: there is no cuobjdump")
            return 0
        body = step_loop(instructions(cuobjdump, target))
        if body is None:
            sys.exit("no loop with two barriers and no call was found in the machine code")
        local = report_steps(body, plan)
        print(f"local memory in the loop of steps: {local} instructions")
        return 1 if args.no_spills and local > 0 else 0


if __name__ == "__main__":
    sys.exit(main())
