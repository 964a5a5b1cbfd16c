"""A disk that fails at every call in turn, for each kind of run; disk_test.py tries some of the calls."""

from faulty_disk import SCENARIOS, try_faults

for name in SCENARIOS:
    if name == "sweep":  # its runs are runs like the others
        try_faults(name, 1, pattern="{root}/result@(|/summary*)")
    else:
        try_faults(name, 1)
