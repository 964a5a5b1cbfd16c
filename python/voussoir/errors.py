"""The exceptions of this package. All of them are voussoir.Error, too."""


class Error(RuntimeError):
    """What the engine could not do, as one sentence."""


class InputError(Error, ValueError):
    """A mistake in a case file or in settings: "settings:2: soil.modulus: must be positive, is -3 GPa".

    Attributes:
        place: "case.toml:12"; "settings:2" for the second entry of a dictionary of settings; "--set" for an override
        file: the place without its line: "case.toml", "settings" or "--set"
        line: line of the file or number of the setting, from 1; None where there is none
        key: the key that has the mistake, such as "soil.modulus"; empty where the file itself has it
        sentence: what is wrong, without place and key
    """

    def __init__(self, message: str, place: str = "", key: str = "", sentence: str = "") -> None:
        super().__init__(message)
        self.place = place
        self.key = key
        self.sentence = sentence or message
        file, colon, line = place.rpartition(":")
        is_line = bool(colon) and line.isdigit()
        self.file = file if is_line else place
        self.line = int(line) if is_line else None

    def __reduce__(self) -> tuple[type, tuple[str, ...]]:
        return type(self), (str(self), self.place, self.key, self.sentence)


class NoEquilibrium(Error):
    """Grains do not come to rest: no packing of a recipe does, or an increment of a run finds no equilibrium."""


class PackingWarning(UserWarning):
    """A packing was left out, or a setting of packings is not used."""
