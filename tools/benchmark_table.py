#!/usr/bin/env python3
"""Markdown rows of a benchmark report, for docs/measurements/performance.md: tools/benchmark_table.py REPORT.json ...

A report is the file of --benchmark_out=FILE. Each benchmark gets one row: contacts per grain, then in million the
medians of particle-steps/s in float and double, and of contact-steps/s and listed-pair-steps/s in float. Each report
(for example of one thread and of two) makes a table of its own under a line about its machine.
"""

import json
import sys
from pathlib import Path


def medians(path):
    """(context, {scene: {precision: counters}}) of a report."""
    report = json.loads(Path(path).read_text())
    scenes: dict[str, dict[str, dict]] = {}
    for run in report["benchmarks"]:
        if run.get("aggregate_name") == "median":
            scene, precision = run["run_name"].split("/")[:2]
            scenes.setdefault(scene, {})[precision] = run
    return report["context"], scenes


def row(scene, runs):
    def rate(precision, counter):
        value = runs.get(precision, {}).get(counter)
        return "" if value is None else f"{value / 1e6:.0f}"

    some = next(iter(runs.values()))
    cells = [
        f"`{scene}`",
        f"{some['coordination']:.1f}",
        rate("float", "particle_steps/s"),
        rate("double", "particle_steps/s"),
        rate("float", "contact_steps/s"),
        rate("float", "pair_steps/s"),
    ]
    return "| " + " | ".join(cells) + " |"


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for path in sys.argv[1:]:
        try:
            context, scenes = medians(path)
        except (OSError, ValueError, KeyError) as reason:
            sys.exit(f"{path}: no readable report: {reason}")
        print(f"{context['device']}, {context['lanes']}, {context['concurrency']} thread(s), {context['date'][:10]}\n")
        print("| benchmark | contacts per grain | float | double | contact-steps, float | listed-pair-steps, float |")
        print("|---|---|---|---|---|---|")
        print("\n".join(row(scene, runs) for scene, runs in scenes.items()) + "\n")


if __name__ == "__main__":
    main()
