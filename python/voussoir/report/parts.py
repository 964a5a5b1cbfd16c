"""The parts that pages of all sorts have: figures, input, provenance, cost."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from voussoir.figures import trend_table
from voussoir.figures.output import is_of_the_machine
from voussoir.figures.result import Missing, Result, Unreadable
from voussoir.figures.study import judging

from . import facts, markup
from .markup import Page
from .pictures import Drawn


class Builder:
    """A page in the making, with what becomes of the tool's exit status."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.unreadable = False
        self.faults: list[str] = []
        self.missing: list[str] = []

    def note(self, reason: Missing) -> None:
        """Data that are not there; a damaged file is told at the top, the rest where the figures stand."""
        if isinstance(reason, Unreadable):
            self.unreadable = True
            self.page.warnings.append(f"Left out: {reason}.")
        else:
            self.missing.append(str(reason))

    def charts(self, makers: Sequence[Callable[[], dict[str, Any]]]) -> str:
        """The charts whose data are there."""
        made = []
        for make in makers:
            try:
                made.append(self.page.chart(make()))
            except Missing as reason:
                self.note(reason)
        return "".join(made)

    def figures(self, drawn: Drawn) -> None:
        """The figures, and why others are not among them."""
        self.unreadable = self.unreadable or drawn.unreadable
        self.faults += drawn.faults
        self.page.add(
            "Figures",
            f'<div class="figures">{"".join(markup.figure(p) for p in drawn.pictures)}</div>' if drawn.pictures else "",
        )
        for name, text in drawn.tables:
            self.page.add(f"Table: {name.replace('_', ' ')}", markup.markdown(text))
        lines = [*dict.fromkeys([*self.missing, *drawn.missing]), *(f"Fault of this tool in {f}" for f in drawn.faults)]
        if lines:
            content = "".join(f"<li>{markup.text(line)}</li>" for line in lines)
            self.page.add("What is missing, and why", f"<ul>{content}</ul>")

    def judged(self, title: str, rows: Sequence[judging.Judged]) -> None:
        """Trends that are judged over several members or tunnels."""
        self.faults += [f"{row.statement}: {error}" for row in rows for error in row.faults]
        shown = [(row.statement, f"<b>{markup.text(row.verdict)}</b>", row.numbers) for row in rows]
        self.page.add(title, markup.table(("trend", "verdict", "numbers"), shown))

    def trends(self, result: Result) -> None:
        """The study's trends, each seen or not."""
        rows, faults = trend_table.table(result)
        for error in faults:
            if is_of_the_machine(error):
                raise error
            self.faults.append(f"trends: {type(error).__name__}: {error}")
        shown = [(row.statement, f"<b>{markup.text(row.verdict)}</b>", row.numbers) for row in rows]
        self.page.add("The study's trends", markup.table(("trend", "verdict", "numbers"), shown))

    def origin(self, of: facts.Facts) -> None:
        """Cost, input and provenance of one run."""
        rows = facts.cost(of)
        self.page.add("Cost", markup.table((), rows) if rows else "")
        if of.input:
            self.page.add(
                "Input", markup.folded("the resolved case, with all defaults", f"<pre>{markup.text(of.input)}</pre>")
            )
        self.page.add("Provenance", markup.table((), sorted(of.provenance.items())) if of.provenance else "")


def name_of(folder: Path) -> str:
    resolved = folder.resolve()
    return f"{resolved.parent.name}/{resolved.name}" if resolved.name.startswith("member_") else resolved.name
