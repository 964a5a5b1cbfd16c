"""Formulas between $ and $$ become MathML Core, which browsers draw without a script."""

import re

from math_core import LatexError, LatexToMathML

_converter = LatexToMathML(fancy_error=False)


class FormulaError(Exception):
    pass


def mathml(latex: str, display: bool) -> str:
    """The formula for a page; the search leaves its letters out. A command that is not known is an error."""
    try:
        text = _converter.convert_with_local_state(latex.strip(), displaystyle=display)
    except LatexError as error:
        raise FormulaError(re.sub(r"\s+", " ", str(error)).strip()) from None
    return text.replace("<math", '<math data-search-exclude=""', 1)
