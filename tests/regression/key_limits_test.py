"""Some keys at the ends of their limits, with `check` and `run`. key_limits_long_test.py tries all keys, and the unit
test host_key_limits_test tries all that needs no run."""

from collections.abc import Callable
from functools import partial
from itertools import count

from key_limits import Trial, keys_of_kind, limits_of, try_all

# Values that once ended in a crash, in exit code 4, or in a number that is none.
TRIED = {
    "pack": ("soil.stiffness_ratio", "soil.modulus", "soil.thickness", "soil.size_minimum", "packing.seed"),
    "biaxial_bvp": ("soil.stiffness_ratio", "biaxial_bvp.width"),
}
number = count()
jobs: list[Callable[[], str | None]] = []
for kind, names in TRIED.items():
    for key in keys_of_kind(kind):
        if key["key"] in names:
            for at_limit, beside, outside, words in limits_of(key):
                jobs.append(Trial(next(number), kind, key, at_limit, beside).runs)
                jobs.append(partial(Trial(next(number), kind, key, outside).refused, words))
try_all(jobs)
