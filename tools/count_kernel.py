#!/usr/bin/env python3
"""Counts what one particle-step of the GPU engine costs, from its compiled code and a packing: registers, spills, fast
memory, blocks that share a multiprocessor, instructions of the loop of steps, wavefronts of shared memory, and from
these an estimate of the rate on an H100. Needs nvcc and Kokkos for CUDA (tools/setup --cuda) and no GPU.

    tools/count_kernel.py [--precision float|double] [--plan Small|Middle|Large] [--packing FILE]
    tools/count_kernel.py --check

--check compares the plan Middle in float with the counts that were written down here and exits with 1 where they
differ, with 77 where nvcc or a tool that reads machine code is missing."""

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
GRAINS = {"Small": 300, "Middle": 700, "Large": 1500}  # of the RVEs for which a plan is meant
SKIN = 0.08  # of the lists, over the mean diameter: the default of engine.skin
# An H100 SXM. Registers and shared memory of compute capability 9.0; each block takes 1 KiB more than it asks for.
MULTIPROCESSORS, CLOCK, ISSUED_A_CYCLE = 132, 1.98e9, 4
REGISTERS_OF_SM, FAST_OF_SM, RESERVED, THREADS_OF_SM = 65536, 227 * 1024, 1024, 2048
# What the prototype's variants used of the data stage of L1 and of the issue slots
# (docs/measurements/gpu_prototype.md): 70 % and 53 % as it was designed; 91 % and 67 % at best, with 24 warps. Lists
# and a look every 16 steps left it 0.84 of its rate.
DESIGNED, BEST, WITH_LISTS = (0.70, 0.53), (0.91, 0.67), 0.84
TEAM_INSTRUCTIONS, TEAM_WAVEFRONTS = 17.4, 28.7  # of a particle-step of the team kernel that this engine replaced
# The plan Middle in float, as it is compiled by CUDA 13.0 for sm_90.
EXPECTED_INSTRUCTIONS, EXPECTED_FAST = 1089, 80880

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
  constexpr int threads = {threads};
  char* const none = device::no_memory();
  const Memory sizes(none, none, threads * {grain_slots}, threads * {pair_slots}, threads);
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

    pairs: list[str]  # of all slots of a thread
    cell: list[str]  # one warp of a block carries the cell on
    grains: list[str]  # between the barriers, of each warp once
    grain: list[str]  # of one grain, without its pairs
    turn: list[str]  # of one pair of a grain

    @property
    def all(self) -> list[str]:
        return self.pairs + self.cell + self.grains + self.grain + self.turn


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
    words = [tool("g++"), "-std=c++20", "-O1", "-fopenmp", f"-I{ROOT}", f"-I{PREFIX / 'kokkos/include'}"]
    subprocess.run([str(w) for w in [*words, source, "-o", target]], check=True)
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


def calls_in(texts):
    return sum(kind(text) == "CALL" for text in texts)


def step_loop(code):
    """The loop of plain steps: the longest one with two barriers and no call, or else the one with fewest calls."""
    loops = []
    for first, last in backward_branches(code):
        texts = [text for _, text in code[first : last + 1]]
        if sum("BAR.SYNC" in t for t in texts) == 2:
            loops.append((calls_in(texts), -len(texts), code[first : last + 1]))
    if not loops:
        sys.exit("no loop with two barriers was found in the machine code")
    return min(loops, key=lambda loop: loop[:2])[2]


def parts_of(code):
    """The parts of the loop of steps. The cell's part is skipped by all warps but one: it ends where the first branch
    behind the barrier leads to. The loop over a grain's pairs is the shortest one, that over grains surrounds it."""
    texts = [text for _, text in code]
    barrier = next(k for k, t in enumerate(texts) if "BAR.SYNC" in t)
    loops = [loop for loop in backward_branches(code) if loop[0] > barrier]
    if len(loops) < 2:
        sys.exit("the loop over grains, or that over a grain's pairs, was not found in the machine code")
    turn = min(loops, key=lambda loop: loop[1] - loop[0])
    grain = min((loop for loop in loops if loop != turn and loop[0] <= turn[0]), key=lambda loop: loop[1] - loop[0])
    skip = next(k for k in range(barrier, grain[0]) if re.search(r"\bBRA\b", texts[k]))
    address = int(found_in(r"(0x[0-9a-f]+)", texts[skip]), 16)
    cell_end = next(k for k, (at, _) in enumerate(code) if at == address)
    return Loop(
        pairs=texts[: barrier + 1],
        cell=texts[skip + 1 : cell_end],
        grains=texts[barrier + 1 : skip + 1] + texts[cell_end : grain[0]] + texts[grain[1] + 1 :],
        grain=texts[grain[0] : turn[0]] + texts[turn[1] + 1 : grain[1] + 1],
        turn=texts[turn[0] : turn[1] + 1],
    )


def local_accesses(loop):
    """Instructions that move spilled numbers."""
    return sum(kind(text) in ("LDL", "STL") for text in loop.all)


def instructions_of(loop, plan, grains, cost):
    """Warp instructions a particle-step of an RVE of so many grains."""
    of_warps = plan.threads / 32 * len(loop.grains) / grains
    of_grain = len(loop.grain) + cost.turns * len(loop.turn)
    return (
        cost.pair_warps * len(loop.pairs) / plan.pair_slots
        + cost.grain_warps * of_grain
        + of_warps
        + len(loop.cell) / grains
    )


def report_code(name, precision, of, loop):
    """What the compiler made of the kernel."""
    plan = plan_of(name)
    grains, pairs = plan.threads * plan.grain_slots, plan.threads * plan.pair_slots
    print(f"{name}, {precision}: {plan.threads} threads, up to {grains} grains and {pairs} pairs")
    print(f"registers {of.registers}, stack {of.stack} bytes, spilled {of.spilled} bytes (all code of the kernel)")
    print(f"a block has {of.fast} bytes of fast memory and {of.slow} bytes of the device's memory")
    print(f"a multiprocessor has {of.blocks} blocks, {of.blocks * plan.threads // 32} warps")
    counts = Counter(kind(text) for text in loop.all)
    shown = ("FFMA", "FMUL", "FADD", "MUFU", "DFMA", "DMUL", "DADD", "LDS", "STS", "LDG", "STG", "LDL", "STL", "BRA")
    print(f"loop of steps: {len(loop.all)} instructions: " + ", ".join(f"{k} {counts[k]}" for k in shown if counts[k]))
    print(
        f"of them {len(loop.pairs)} for {plan.pair_slots} pairs, {len(loop.grain)} for a grain, {len(loop.turn)} for "
        f"each of its pairs, {len(loop.cell)} for the cell"
    )
    print(
        f"local memory in the loop of steps: {local_accesses(loop)} instructions; calls, of rare cases of divisions "
        f"and roots: {calls_in(loop.all)}"
    )


def report_step(name, precision, loop, packing):
    """What a particle-step takes on a packing, and the rate that follows."""
    radius, position, cell = step_wavefronts.read_packing(packing)
    lists = step_wavefronts.lists_of(radius, position, cell, SKIN)
    cost = step_wavefronts.step_cost(lists, 4 if precision == "float" else 8)
    issued = instructions_of(loop, plan_of(name), GRAINS[name], cost)
    wavefronts = cost.pair_wavefronts + cost.grain_wavefronts
    print(
        f"{packing.name}: {lists.grains} grains, {lists.listed:.2f} listed pairs a grain; a warp goes {cost.turns:.1f} "
        f"times through the loop over a grain's pairs"
    )
    print(
        f"a particle-step of {GRAINS[name]} such grains: {issued:.1f} warp instructions (team kernel "
        f"{TEAM_INSTRUCTIONS}), {wavefronts:.1f} wavefronts of shared memory ({cost.pair_wavefronts:.1f} of pairs, "
        f"{cost.grain_wavefronts:.1f} of grains; team kernel {TEAM_WAVEFRONTS})"
    )
    low, high = (
        MULTIPROCESSORS * CLOCK * min(of_l1 / wavefronts, of_issue * ISSUED_A_CYCLE / issued) / 1e9
        for of_l1, of_issue in (DESIGNED, BEST)
    )
    print(
        f"estimate for an H100 ({MULTIPROCESSORS} SM, {CLOCK / 1e9:.2f} GHz) with many RVEs: {low:.0f} to {high:.0f} G "
        f"particle-steps/s in steps alone, if {DESIGNED[0]:.0%} to {BEST[0]:.0%} of the wavefronts and "
        f"{DESIGNED[1]:.0%} to {BEST[1]:.0%} of the issue slots are used, as by the prototype"
    )
    print(
        f"with lists and looks {WITH_LISTS * low:.0f} to {WITH_LISTS * high:.0f} G; restoring, finishing and tangents "
        f"are not counted"
    )


def faults_of(of, loop, plan):
    """What differs from the counts that were written down."""
    limit = REGISTERS_OF_SM // (plan.threads * plan.blocks)
    count = len(loop.all)
    if local_accesses(loop) > 0:
        yield f"the loop of steps moves spilled numbers with {local_accesses(loop)} instructions"
    if calls_in(loop.all) > 0:
        yield f"the loop of steps has {calls_in(loop.all)} calls"
    if of.registers > limit:
        yield f"{of.registers} registers a thread are more than the plan's {limit}"
    if of.fast != EXPECTED_FAST:
        yield f"a block has {of.fast} bytes of fast memory instead of {EXPECTED_FAST}"
    if of.blocks != plan.blocks:
        yield f"{of.blocks} blocks share a multiprocessor instead of {plan.blocks}"
    if abs(count - EXPECTED_INSTRUCTIONS) > 0.1 * EXPECTED_INSTRUCTIONS:
        yield f"the loop of steps has {count} instructions instead of {EXPECTED_INSTRUCTIONS} within 10 %"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--precision", choices=("float", "double"), default="float")
    parser.add_argument("--plan", choices=tuple(GRAINS), default="Middle")
    parser.add_argument("--packing", type=Path, default=PACKING, help="a stored packing, or a file NAME_particles.csv")
    parser.add_argument("--check", action="store_true", help="compare Middle in float with the counts written down")
    args = parser.parse_args()
    if args.check:
        args.precision, args.plan = "float", "Middle"
    try:
        with tempfile.TemporaryDirectory() as name:
            target, of = compiled(args.precision, args.plan, Path(name))
            loop = parts_of(step_loop(machine_code(target)))
    except Missing as missing:
        print(f"skipped: {missing}")
        return 77
    report_code(args.plan, args.precision, of, loop)
    report_step(args.plan, args.precision, loop, args.packing)
    faults = list(faults_of(of, loop, plan_of(args.plan))) if args.check else []
    for fault in faults:
        print(f"FAILED: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
