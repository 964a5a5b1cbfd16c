"""The study's trends over the members: how many of them show each trend, and the numbers with their bands."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from .. import comparison, output, trend_table, trends
from ..result import Missing, Result
from .data import Study, Tunnel
from .merging import merge

Judge = Callable[[Sequence[Result]], trends.Trend]  # of comparison.TRENDS


@dataclass
class Judged:
    """A trend, with the verdict of each member."""

    statement: str
    verdicts: list[str]
    numbers: str
    faults: list[Exception] = field(default_factory=list)

    @property
    def verdict(self) -> str:
        """ "seen in 3 of 4"; where all members say the same of it, that."""
        counts = Counter(self.verdicts)
        judged = counts[trends.SEEN] + counts[trends.NOT_SEEN]
        if judged == 0:
            return counts.most_common(1)[0][0]
        if len(self.verdicts) == 1:
            return self.verdicts[0]
        further = "".join(
            f", {count} {verdict}" for verdict, count in counts.items() if verdict not in (trends.SEEN, trends.NOT_SEEN)
        )
        return f"seen in {counts[trends.SEEN]} of {len(self.verdicts)}{further}"


def of_tunnel(tunnel: Tunnel) -> list[Judged]:
    """All trends of one tunnel. The members have the same rows unless a part of one failed, which is then left out."""
    rows: dict[str, list[trends.Trend]] = {}
    faults: list[Exception] = []
    for member in tunnel.members:
        found, failed = trend_table.table(member)
        faults += failed
        for row in found:
            rows.setdefault(row.statement, []).append(row)
    judged = [_together(statement, same) for statement, same in rows.items()]
    if judged:
        judged[0].faults = faults
    return judged


def _together(statement: str, rows: Sequence[trends.Trend]) -> Judged:
    return Judged(statement, [row.verdict for row in rows], merge([row.numbers for row in rows]))


def between(study: Study) -> list[Judged]:
    """The trends between tunnels. Members of the same number have the seeds of the same draw in each tunnel, so the
    first members are compared with one another, then the second ones, and so on as far as each tunnel has them."""
    count = min(tunnel.count for tunnel in study.tunnels)
    draws = [[tunnel.members[k] for tunnel in study.tunnels] for k in range(count)]
    return [_judge(judge, draws) for judge in comparison.TRENDS]


def _judge(judge: Judge, draws: Sequence[Sequence[Result]]) -> Judged:
    rows: list[trends.Trend] = []
    faults: list[Exception] = []
    for results in draws:
        try:
            rows.append(judge(results))
        except Missing as reason:
            rows.append(trends.Trend(comparison.statement(judge), trends.NO_DATA, str(reason)))
        except Exception as error:
            if output.is_of_the_machine(error):
                raise
            rows.append(trends.fault(comparison.statement(judge), error))
            faults.append(error)
    judged = _together(rows[0].statement, rows)
    judged.faults = faults
    return judged
