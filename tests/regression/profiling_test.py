"""A profiler sees the parts of an evaluation by the method's own names, properly nested, one thread's at a time."""

import os
from pathlib import Path

from program import PROGRAM, check, fresh, run

TOOL = os.environ["VOUSSOIR_REGION_TOOL"]
LOOP = "voussoir::lanes::groups"


def regions_of(words):
    """How often each region or loop was entered, by its path."""
    log = Path("regions.txt")
    log.unlink(missing_ok=True)
    os.environ["KOKKOS_TOOLS_LIBS"] = TOOL
    os.environ["VOUSSOIR_REGION_LOG"] = str(log.resolve())
    try:
        run(words)
    finally:
        del os.environ["KOKKOS_TOOLS_LIBS"]
    lines = log.read_text().splitlines()
    check(
        "mixed threads" not in lines,
        "two threads tell the tool their regions at once, which common tools do not expect",
    )
    check("unbalanced" not in lines, "a region is left open")
    return {path: int(count) for path, count in (line.rsplit(" ", 1) for line in lines)}


def entered(regions, name):
    """Entries of `name` within the loop over groups, whatever is around it."""
    return sum(n for path, n in regions.items() if f"{LOOP}/" in path and path.endswith(f"/{name}"))


# Consolidation moves grains far, so lists are renewed; the probe asks for static tangents.
Path("probe.toml").write_text('kind = "probe"\n[engine]\nprecision = "double"\n[probe]\ntangent = "elastic"\n')
settings = ["packing.grains=60", "packing.seeds=[1]", "packing.candidates=1", f"packing.folder={fresh('packings')}"]
probe = [PROGRAM, "run", "probe.toml", "-o", str(fresh("probed"))]
for setting in settings:
    probe += ["--set", setting]
regions = regions_of(probe)
for name in ("restore", "lists", "sweep", "tangents", "finish"):
    check(entered(regions, name) > 0, f"no region {name} in {sorted(regions)}")
check(entered(regions, "sweep") > 100 * entered(regions, "restore"), "a sweep is a step, and groups take many")
check(entered(regions, "restore") == entered(regions, "finish"), "groups begin and end alike")
check(entered(regions, "tangents") < entered(regions, "finish"), "tangents were found without being asked for")
