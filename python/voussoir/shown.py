"""What all results have in common: one line for the terminal, a picture for a notebook, figures and the report page."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .pictures import Picture


class Shown:
    """What Result, Ensemble and Sweep have in common: they can be drawn, which needs matplotlib, and a notebook shows
    them."""

    folder: Path
    kind: str

    def _facts(self) -> list[str]:
        """What stands in the line below the picture."""
        return []

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.folder}: {', '.join(self._facts())}>"

    def _repr_html_(self) -> str:
        from .notebook import result_html

        return result_html(self, self._facts())

    def figure(self, name: str = "", **settings: Any) -> "Picture":
        """One figure by its name in docs/reference/figures.md, such as "settlement_troughs", as a picture that a
        notebook shows; without a name the one that a notebook shows of this result. `settings` are places and volume
        losses that figures show, such as `depths=(0, 0.5)`: losses, field_losses, depths, above_crown, aside,
        aside_above, line, as the options of tools/figures.py with these names, and range_of_k; losses are shares (0.05)
        and not percent.

        Raises Missing where the result lacks what the figure needs, ValueError where there is no such figure, TypeError
        where there is no such setting."""
        from . import pictures

        return pictures.figure(self.folder, name, **settings)

    def figures(
        self,
        folder: Path | str | None = None,
        form: str = "png",
        only: Sequence[str] | None = None,
        **settings: Any,
    ) -> list[Path]:
        """Draws the figures for which there are data, all or `only` these, as png, pdf or svg, into a folder (the
        result's own), and returns the files; those without data are left out."""
        from . import pictures

        return pictures.figures(self.folder, folder, form, only, **settings)

    def report(self, file: Path | str | None = None, only: Sequence[str] | None = None, **settings: Any) -> Path:
        """Writes one HTML page, which needs no server and no network (report.html in the folder), and returns it.
        `only`: the figures on it; all of them unless it is given."""
        from . import pictures

        return pictures.report(self.folder, file, only, **settings)
