"""Every key of every kind of case at both ends of its limits: `check` takes the value, and a run of a tiny case ends
with an answer or says why it has none; one step outside, the refusal names file, line, key and limit."""

from collections.abc import Callable
from functools import partial
from itertools import count

from key_limits import KINDS, Trial, keys_of_kind, limits_of, number_has_limits, try_all, values_inside
from program import check

number = count()
jobs: list[Callable[[], str | None]] = []
for kind in KINDS:
    for key in keys_of_kind(kind):
        check(not number_has_limits(key), number_has_limits(key))
        for at_limit, beside, outside, words in limits_of(key):
            jobs.append(Trial(next(number), kind, key, at_limit, beside).runs)
            jobs.append(partial(Trial(next(number), kind, key, outside).refused, words))
        jobs.extend(Trial(next(number), kind, key, value).runs for value in values_inside(key))
try_all(jobs)
