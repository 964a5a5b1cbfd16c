"""Formulas between $ and $$ become MathML Core, which browsers draw without a script."""

import html
import re
from xml.etree import ElementTree

from math_core import LatexError, LatexToMathML

_converter = LatexToMathML(fancy_error=False)
_ENTITY = re.compile(r"&(?!lt;|gt;|amp;|#)\w+;")  # known to HTML and not to XML
_RELATIONS = ("=", "<", ">", "≤", "≥", "≈", "∝", "→")
_INLINE = re.compile(r"<math(?![^>]*data-search-exclude).*?</math>", re.DOTALL)


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


def plain(text: str) -> str:
    """A formula that is MathML as one line of plain text, for titles and for the search: roots and fractions are
    written with their signs, exponents with ^, and indices follow their letter."""
    root = ElementTree.fromstring(_ENTITY.sub(lambda entity: html.unescape(entity[0]), text))
    return re.sub(r"\s+", " ", _plain(root)).strip()


def without_formulas(page: str) -> str:
    """A page's HTML with all inline formulas as plain text, for the index of the search."""
    return _INLINE.sub(lambda formula: html.escape(plain(formula[0])), page)


def _plain(element: ElementTree.Element) -> str:
    kind = element.tag.rpartition("}")[2]
    parts = [_plain(child) for child in element]
    if kind == "mspace":
        return " "
    if kind == "msqrt":
        return "√" + _bracketed("".join(parts))
    if kind == "mfrac":
        return "/".join(_bracketed(part) for part in parts)
    if kind in ("msup", "msubsup"):
        return "".join(parts[:-1]) + "^" + _bracketed(parts[-1])
    own = (element.text or "").replace("\N{FUNCTION APPLICATION}", " ")
    return (f" {own} " if own in _RELATIONS else own) + "".join(parts)


def _bracketed(text: str) -> str:
    """Text of more than one number or letter in brackets."""
    return text if re.fullmatch(r"[−-]?[\d.]+|.?", text.strip()) else f"({text})"
