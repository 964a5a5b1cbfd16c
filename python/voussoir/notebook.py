"""What a notebook shows of results, tables and packings. Nothing here fails: what cannot be drawn is left out."""

import base64
import html
import io
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .errors import Error
from .files import Table
from .sweeps import Sweep

if TYPE_CHECKING:
    from .shown import Shown

MOST_ROWS = 20  # of a table, that are shown


def result_html(result: "Shown", facts: Sequence[str]) -> str:
    """The picture of a result, with a line of facts below it; of a sweep its table."""
    line = f"<b>{html.escape(str(result.folder))}</b>: {html.escape('; '.join(facts))}"
    if isinstance(result, Sweep):
        return f"<div>{line}{table_html(result.table)}</div>"
    try:
        picture = result.figure()
    except (Error, ImportError):  # a result that has no picture yet, or no matplotlib
        return f"<div>{line}</div>"
    return f"<div>{png_html(picture.content)}<br>{line}</div>"


def png_html(content: bytes) -> str:
    return f'<img style="max-width:720px;width:100%" src="data:image/png;base64,{base64.b64encode(content).decode()}">'


def table_html(table: Table) -> str:
    """The first rows of a table, with the units below the names."""
    names = list(table)
    head = "".join(f"<th>{html.escape(name)}</th>" for name in names)
    units = "".join(f"<td>{html.escape(table.units[name])}</td>" for name in names)
    rows = ["".join(f"<td>{_cell(table[name][k])}</td>" for name in names) for k in range(min(table.rows, MOST_ROWS))]
    body = "".join(f"<tr>{row}</tr>" for row in (units, *rows))
    more = f"<caption>the first {MOST_ROWS} of {table.rows} rows</caption>" if table.rows > MOST_ROWS else ""
    return f"<table>{more}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _cell(value: object) -> str:
    return f"{value:.5g}" if isinstance(value, float) else html.escape(str(value))


def packing_png(
    radius: np.ndarray, position: np.ndarray, cell: np.ndarray, contacts: np.ndarray | None = None, title: str = ""
) -> bytes | None:
    """The grains of a packing as a PNG, or None without matplotlib; arguments: voussoir.figures.chains.draw_packing."""
    try:
        import matplotlib
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from .figures.chains import draw_packing
    except ImportError:
        return None
    with matplotlib.rc_context():
        figure = Figure(figsize=(3.6, 3.8), layout="constrained")
        canvas = FigureCanvasAgg(figure)
        axis = figure.subplots()
        draw_packing(axis, radius, position, cell, contacts)
        axis.set_title(title, fontsize=9)
        picture = io.BytesIO()
        canvas.print_png(picture)
    return picture.getvalue()
