#!/usr/bin/env python3
"""What a call of RveBatch.evaluate costs beside the engine: for several numbers of RVEs, the wall time of the call in
Python, the part of it within RvePool::evaluate, which a C++ program would call, and the difference.

    PYTHONPATH=build/openmp/python python/benchmarks/call_overhead.py [--grains 300] [--calls 30]

The difference is the median over the calls, because other processes of the machine disturb single calls. Prints a table
in Markdown.
"""

import argparse
import time

import numpy as np
import voussoir

SIZES = (1, 16, 1024, 4096)
STRAIN = 1e-3  # of the long calls
REST = 0.0  # without a strain the grains are only looked at: the shortest call that there is


def measure(batch, strain, calls):
    """Wall time of a call and its part beside the engine, in seconds: medians over the calls."""
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
    return float(np.median(walls)), float(np.median(besides))


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
        print(
            f"| {n} | {rest * 1e3:.3g} | {rest_beside * 1e6:.3g} | {wall * 1e3:.4g} | {beside * 1e6:.3g} |", flush=True
        )


if __name__ == "__main__":
    main()
