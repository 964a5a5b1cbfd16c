#!/usr/bin/env python3
"""Compares two benchmark reports: tools/compare_runs.py BEFORE.json AFTER.json.

A report is the file of --benchmark_out=FILE. Prints the median particle-steps/s [million] of each benchmark in both and
the ratio AFTER / BEFORE; also prints how the machines differ, since a ratio between two machines does not show progress
of the code.
"""

import argparse
import json
import sys
from pathlib import Path


def load(path):
    """(context, {benchmark: median particle-steps/s}) of a report."""
    report = json.loads(Path(path).read_text())
    rates = {b["run_name"]: b["particle_steps/s"] for b in report["benchmarks"] if b.get("aggregate_name") == "median"}
    return report["context"], rates


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    arguments = parser.parse_args()
    (context, before), (other, after) = load(arguments.before), load(arguments.after)
    for key in ("device", "lanes", "backend", "concurrency", "library_build_type"):
        if context.get(key) != other.get(key):
            print(f"{key} differs: {context.get(key)} | {other.get(key)}")
    for path, rates in ((arguments.before, before), (arguments.after, after)):
        for name in sorted(set(before) ^ set(after)):
            if name in rates:
                print(f"only in {path}: {name}")
    common = [name for name in before if name in after]
    if not common:
        sys.exit("no benchmark in common")
    width = max(map(len, common))
    print(f"{'':{width}}  {'before':>8}  {'after':>8}  ratio")
    for name in common:
        print(f"{name:{width}}  {before[name] / 1e6:8.2f}  {after[name] / 1e6:8.2f}  {after[name] / before[name]:5.3f}")


if __name__ == "__main__":
    main()
