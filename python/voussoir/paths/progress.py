"""Lines that tell how far a dataset is."""

import sys
import time
from collections.abc import Callable

EVERY = 5.0  # seconds


class Progress:
    """Counts row increments (one row, one increment), and tells of them."""

    def __init__(self, total: int, how: bool | Callable[[int, int], None]) -> None:
        self.total, self.how = total, how
        self.started = self.told = time.monotonic()
        self.first = 0

    def begin(self, done: int) -> None:
        """So many were done before, by another process perhaps: they do not count for the rate."""
        self.first = max(self.first, done)
        self.started = time.monotonic()

    def __call__(self, done: int) -> None:
        if callable(self.how):
            self.how(done, self.total)
        elif self.how and (time.monotonic() - self.told > EVERY or done == self.total):
            self.told = time.monotonic()
            rate = (done - self.first) / max(self.told - self.started, 1e-9)
            left = (self.total - done) / max(rate, 1e-9)
            share = f"{100 * done / self.total:.0f} %"
            print(f"{share} of {self.total} row increments, {rate:.0f} a second, {left:.0f} s left", file=sys.stderr)
