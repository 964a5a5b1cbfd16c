"""Results of the kinds without a run.h5: a probe (csv files, docs/reference/files.md) and packings."""

from pathlib import Path

from .errors import Missing, Unreadable
from .files import read_rows, table_of_rows
from .packing_files import PackingFile, packing_files, table_of_packings
from .results import Result


class ProbeResult(Result):
    """A probe: tables "probe" (responses and tangents, a row for each probe and replica) and, where the probe had a
    path, "path". Stresses in Pa, tension positive; a column's name ends in its unit."""

    def _read(self) -> None:
        self.kind = "probe"
        for name in ("probe", "path"):
            file = self.folder / f"{name}.csv"
            if name == "path" and not file.exists():
                continue
            try:
                self.tables[name] = table_of_rows(read_rows(file, ["seed", "replica"]))
            except Missing as reason:
                if name == "probe":
                    raise
                self.left_out.append(reason)

    @property
    def ends(self) -> dict[int, PackingFile]:
        """The packings at the end of the path, by their seeds; empty without a path."""
        files = sorted(self.folder.glob("end_*.h5"))
        return {int(file.stem.removeprefix("end_")): PackingFile(file) for file in files}


class PackResult(Result):
    """A folder of packings, or some packing files: `packings`, and the table "packings" with a row for each."""

    def __init__(self, folder: Path | str) -> None:
        self.packings: list[PackingFile] = []
        super().__init__(folder)

    def _read(self) -> None:
        self.kind = "pack"
        for file in packing_files(self.folder):
            try:
                self.packings.append(PackingFile(file))
            except Missing as reason:
                self.left_out.append(reason)
        if not self.packings:
            raise self.left_out[0] if self.left_out else Unreadable(f"{self.folder} has no packing")
        self.tables["packings"] = table_of_packings(self.packings)

    def _facts(self) -> list[str]:
        grains = sum(len(packing.radius) for packing in self.packings)
        ratios = self.tables["packings"]["void_ratio"]
        count = "1 packing" if len(self.packings) == 1 else f"{len(self.packings)} packings"
        return [count, f"{grains} grains", f"void ratio {ratios.min():.3f} to {ratios.max():.3f}"]


def is_probe(folder: Path) -> bool:
    try:
        return (folder / "probe.csv").exists() and not (folder / "run.h5").exists()
    except OSError as error:
        raise Unreadable(f"{folder} cannot be read: {error.strerror}") from error
