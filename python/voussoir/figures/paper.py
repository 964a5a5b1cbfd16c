"""The paper's figures and tables, one by one: what each shows, which files of ours show the same, or why none does, and
one sentence how our result compares with the paper's.

The files are those of `tools/figures.py` for the folder of a sweep, unless `of` names another source.
"""

from collections.abc import Callable
from dataclasses import dataclass

from .output import is_of_the_machine
from .result import Missing
from .study import micro_sentences, sentences
from .study.data import Study


@dataclass(frozen=True)
class PaperFigure:
    number: str  # "6", "15b", "A1", "Table 2"
    what: str
    files: tuple[str, ...] = ()
    missing: str = ""  # why there is no counterpart; empty where there is one
    compare: Callable[[Study], str] | None = None  # None: its numbers do not come from tunnels
    of: str = "the sweep"  # of which source the files are drawn


FIGURES = (
    PaperFigure("1", "how grains and finite elements are coupled", missing="a sketch of the method"),
    PaperFigure("2", "gradings of the soils", ("grading.png",), of="the packings"),
    PaperFigure("3", "packings after isotropic consolidation", ("packings.png",), of="the packings"),
    PaperFigure(
        "4",
        "biaxial curves, peak and critical state lines",
        ("biaxial_curves.png", "biaxial_strength.png", "biaxial_angles.png"),
        of="the sweep's element tests",
    ),
    PaperFigure("5", "model, mesh and boundaries", missing="a sketch of the model"),
    PaperFigure("6", "stress, K0 and fabric after gravity", ("study_initial.png",), compare=sentences.initial),
    PaperFigure("7", "soil arching", missing="a sketch of the idea"),
    PaperFigure("8", "displacement by cover and V_l", ("study_displacement.png",), compare=sentences.active_zone),
    PaperFigure(
        "9",
        "shear strain by cover and V_l",
        ("study_shear_covers.png",),
        compare=sentences.bands_by_cover,
    ),
    PaperFigure(
        "10", "settlement at several depths by cover", ("study_settlement_covers.png",), compare=sentences.growth
    ),
    PaperFigure("11", "troughs with modified Gauss curves", ("study_troughs.png",), compare=sentences.trough_shapes),
    PaperFigure("12", "widths K_s and K of the troughs", ("study_widths.png",), compare=sentences.trough_widths),
    PaperFigure("13", "settlement by depth and soil", ("study_settlement_soils.png",), compare=sentences.soils_settle),
    PaperFigure("14", "shear strain by soil", ("study_shear_soils.png",), compare=sentences.bands_by_soil),
    PaperFigure("15a", "the typical ground reaction curve", missing="a sketch after another author"),
    PaperFigure("15b", "ground reaction curves by soil", ("study_reaction.png",), compare=sentences.reaction),
    PaperFigure(
        "16", "changes of stress, axes of the major stress", ("study_stress_changes.png",), compare=sentences.stresses
    ),
    PaperFigure("17", "fabric at points of the arch", ("study_fabric.png",), compare=micro_sentences.fabric),
    PaperFigure("18", "turn of stress and fabric", ("study_rotation.png",), compare=micro_sentences.rotation),
    PaperFigure(
        "19",
        "localisation of strain, rotation and void ratio",
        ("study_localisation.png",),
        compare=micro_sentences.localisation,
    ),
    PaperFigure("20", "force chains at Aa, Ab, Ac, B", ("study_force_chains.png",), compare=micro_sentences.chains),
    PaperFigure("21", "q/p, strains and settlement at Aa, Ab, Ac", ("study_rves.png",), compare=micro_sentences.paths),
    PaperFigure(
        "22", "q/p and volume at Aa, Ab, Ac by soil", ("study_rves_soils.png",), compare=micro_sentences.paths_by_soil
    ),
    PaperFigure("23", "connectivity by soil", ("study_connectivity.png",), compare=micro_sentences.connectivity),
    PaperFigure("24", "strong networks at Aa by soil", ("study_strong.png",), compare=micro_sentences.strong_networks),
    PaperFigure("A1", "scatter against the size of the RVE", ("rve_size_variation.png", "rve_size.md")),
    PaperFigure("A2", "curves of RVEs of several sizes", ("rve_size_curves.png",)),
    PaperFigure("Table 1", "parameters of the grains", missing="it is an input: cases/soils has these numbers"),
    PaperFigure("Table 2", "angles of the soils", ("table_2.md",), of="the sweep's element tests"),
)


def sentence(figure: PaperFigure, study: Study) -> str:
    """How our result compares, or why that is not known. A fault of one sentence loses no other one."""
    if figure.missing:
        return f"No counterpart: {figure.missing}."
    if figure.compare is None:
        return f"See {', '.join(figure.files)} of {figure.of}."
    try:
        return figure.compare(study)
    except Missing as reason:
        return f"No data: {reason}."
    except Exception as error:
        if is_of_the_machine(error):
            raise
        return f"Fault of the tool: {type(error).__name__}: {' '.join(str(error).split())}."
