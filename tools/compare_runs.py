#!/usr/bin/env python3
"""Compares two benchmark reports: tools/compare_runs.py BEFORE.json AFTER.json.

A report is the file of --benchmark_out=FILE. Prints the median particle-steps/s [million] of each benchmark in both and
the ratio AFTER / BEFORE; also prints how the machines differ, since a ratio between two machines does not show progress
of the code. Exit status 2: a file is no such report, or they have no benchmark in common.
"""

import argparse
import json
import sys
from pathlib import Path


class NoReportError(Exception):
    """A file cannot be read as a benchmark report; the message names it and the reason."""


def load(path):
    """(context, {benchmark: median particle-steps/s}) of a report."""
    try:
        report = json.loads(Path(path).read_text())
    except OSError as error:
        raise NoReportError(f"{path} cannot be read: {error.strerror}") from error
    except ValueError as error:  # no JSON, or no text at all
        raise NoReportError(f"{path} is no benchmark report: {' '.join(str(error).split())}") from error
    try:
        rates = {
            b["run_name"]: float(b["particle_steps/s"])
            for b in report["benchmarks"]
            if b.get("aggregate_name") == "median" and "particle_steps/s" in b
        }
        return dict(report["context"]), rates
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise NoReportError(f"{path} is no report of our benchmarks ({type(error).__name__}: {error})") from error


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    arguments = parser.parse_args()
    try:
        (context, before), (other, after) = load(arguments.before), load(arguments.after)
    except NoReportError as reason:
        print(reason, file=sys.stderr)
        return 2
    for key in ("device", "lanes", "backend", "concurrency", "library_build_type"):
        if context.get(key) != other.get(key):
            print(f"{key} differs: {context.get(key)} | {other.get(key)}")
    for path, rates in ((arguments.before, before), (arguments.after, after)):
        for name in sorted(set(before) ^ set(after)):
            if name in rates:
                print(f"only in {path}: {name}")
    common = [name for name in before if name in after]
    if not common:
        print("the reports have no benchmark in common (are there medians? --benchmark_repetitions)", file=sys.stderr)
        return 2
    width = max(map(len, common))
    print(f"{'':{width}}  {'before':>8}  {'after':>8}  ratio")
    for name in common:
        ratio = f"{after[name] / before[name]:5.3f}" if before[name] > 0 else "  -"
        print(f"{name:{width}}  {before[name] / 1e6:8.2f}  {after[name] / 1e6:8.2f}  {ratio}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
