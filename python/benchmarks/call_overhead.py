#!/usr/bin/env python3
"""What a call of RveBatch.evaluate costs beside the engine: for several numbers of RVEs, the wall time of the call in
Python, the part of it within RvePool::evaluate, which a C++ program would call, and the difference; and what a state
costs to keep and to take back.

    PYTHONPATH=build/openmp/python python/benchmarks/call_overhead.py [--grains 300] [--calls 30]

Median and least value of the calls are printed, because other processes of the machine disturb some or most of them.
Prints a table in Markdown.
"""

import argparse
import time

import numpy as np
import voussoir

SIZES = (1, 16, 1024, 4096)
STRAIN = 1e-3  # of the long calls
REST = 0.0  # without a strain the grains are only looked at: the shortest call that there is
STATE_SIZE = 100  # RVEs whose states are kept


def measure(batch, strain, calls):
    """Wall time of a call [ms], and its part beside the engine [µs]: "median (least)"."""
    gradients = np.zeros((len(batch), 2, 2))
    gradients[:, 1, 1] = -strain
    batch.begin_increment()
    walls, besides = [], []
    for _ in range(calls):
        start = time.perf_counter()
        batch.evaluate(gradients)
        wall = time.perf_counter() - start
        walls.append(wall)
        besides.append(wall - batch._core.engine_seconds())

    def text(values, unit):
        return f"{np.median(values) / unit:.3g} ({np.min(values) / unit:.3g})"

    return text(walls, 1e-3), text(besides, 1e-6)


def measure_states(batch, calls):
    """Least times of state() and set_state() for one RVE [µs], and the bytes of its state."""
    keep, take = [], []
    for _ in range(calls):
        start = time.perf_counter()
        state = batch.state()
        middle = time.perf_counter()
        batch.set_state(state)
        keep.append(middle - start)
        take.append(time.perf_counter() - middle)
    return *(1e6 * min(times) / len(batch) for times in (keep, take)), len(state) // len(batch)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--grains", type=int, default=300)
    parser.add_argument("--calls", type=int, default=30, help="of the shortest kind; long ones are a third as many")
    options = parser.parse_args()
    packing = voussoir.make_packings(1, grains=options.grains)
    print(f"{options.grains} grains, {voussoir.threads()} threads\n")
    print(
        "| RVEs | call at rest [ms] | beside the engine [µs] | call of a strain of 1e-3 [ms] | beside the engine [µs] |"
    )
    print("|---|---|---|---|---|")
    for n in SIZES:
        with voussoir.RveBatch(packing, n) as batch:
            rest, rest_beside = measure(batch, REST, options.calls)
            wall, beside = measure(batch, STRAIN, max(3, options.calls // (3 if n < 1024 else 10)))
        print(f"| {n} | {rest} | {rest_beside} | {wall} | {beside} |", flush=True)
    with voussoir.RveBatch(packing, STATE_SIZE) as batch:
        keep, take, size = measure_states(batch, 10 * options.calls)
    print(f"\nstate of an RVE, {size} bytes: state() {keep:.2g} µs, set_state() {take:.2g} µs")


if __name__ == "__main__":
    main()
