"""Formulas between $ and $$ become MathML Core, which browsers draw without a script."""

import html
import re

from math_core import LatexError, LatexToMathML

_converter = LatexToMathML(fancy_error=False)


class FormulaError(Exception):
    pass


def mathml(latex: str, display: bool) -> str:
    """The formula for a page. The search reads the letters of inline formulas, which stand for words of a sentence, and
    leaves the others out. A command that is not known is an error."""
    try:
        text = _converter.convert_with_local_state(latex.strip(), displaystyle=display)
    except LatexError as error:
        raise FormulaError(re.sub(r"\s+", " ", str(error)).strip()) from None
    return text.replace("<math", '<math data-search-exclude=""', 1) if display else text


def letters(text: str) -> str:
    """The letters of a formula that is MathML, for places that hold plain text."""
    return html.unescape(re.sub(r"<[^>]+>", "", text)).replace("\N{FUNCTION APPLICATION}", "")
