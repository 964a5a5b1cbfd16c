"""The places and volume losses that the figures show. The study gives them only in its figures; each of them is an
option of tools/figures.py."""

import argparse
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Settings:
    losses: tuple | None = None  # V_l of troughs, profiles and lines [-]; None: quarters of the largest
    field_losses: tuple = (0.05, 0.10, 0.15, 0.20)  # V_l of the fields [-]
    depths: tuple = (0.0, 0.25, 0.5, 0.75, 1.0)  # z/C of troughs and settlements
    # Heights of Aa, Ab, Ac above the crown, in D; None: 0.25 D, 1 D, and 0.75 C, which is the depth z/C = 0.25. The
    # study gives no numbers; of the places that its words allow, Ac contracts there as it says
    # (docs/measurements/unseen_trends.md).
    above_crown: tuple | None = None
    aside: float = 0.25  # B is the most sheared point with x beyond this, in D
    aside_above: float = 0.0  # and at least this height above the crown, in D: RVEs at the wall lose their contacts
    line: float = 0.5  # height of the line of stress rotations above the crown, in D
    range_of_k: tuple = (0.25, 0.45)  # Mair and Taylor's range of K for cohesionless soils


def parse(arguments: argparse.Namespace) -> Settings:
    """Settings from the options that add_options() declares; those not given keep their defaults."""

    def fraction(values: Iterable[float]) -> tuple[float, ...]:
        return tuple(v / 100 for v in values)

    given = {
        "losses": arguments.volume_loss and fraction(arguments.volume_loss),
        "field_losses": arguments.field_loss and fraction(arguments.field_loss),
        "depths": arguments.depths and tuple(arguments.depths),
        "above_crown": arguments.above_crown and tuple(arguments.above_crown),
        "aside": arguments.aside,
        "aside_above": arguments.aside_above,
        "line": arguments.line,
    }
    return Settings(**{name: value for name, value in given.items() if value is not None})


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--volume-loss",
        type=float,
        nargs="+",
        metavar="PERCENT",
        help="volume losses of troughs, profiles and lines; default: quarters of the largest one",
    )
    parser.add_argument(
        "--field-loss",
        type=float,
        nargs="+",
        metavar="PERCENT",
        help="volume losses of the fields; default: 5 10 15 20",
    )
    parser.add_argument(
        "--depths",
        type=float,
        nargs="+",
        metavar="Z/C",
        help="depths of troughs and settlements over the cover; default: 0 0.25 0.5 0.75 1",
    )
    parser.add_argument(
        "--above-crown",
        type=float,
        nargs=3,
        metavar="D",
        help="heights of the points Aa, Ab, Ac above the crown over the diameter; default: 0.25, 1, and 0.75 C",
    )
    parser.add_argument(
        "--aside",
        type=float,
        metavar="D",
        help="least distance of the point B from the axis over the diameter; default: 0.25",
    )
    parser.add_argument(
        "--aside-above",
        type=float,
        metavar="D",
        help="least height of the point B above the crown over the diameter; default: 0",
    )
    parser.add_argument(
        "--line",
        type=float,
        metavar="D",
        help="height of the line of stress rotations above the crown over the diameter; default: 0.5",
    )
