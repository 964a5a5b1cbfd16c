"""Texts with numbers that differ from member to member, put together into one text with means and bands."""

import re
from collections import Counter
from collections.abc import Sequence

import numpy as np

from .bands import number

NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w])")


def merge(texts: Sequence[str]) -> str:
    """One text of several that have the same clauses (between semicolons). Numbers become mean ± half width of the 95 %
    band of the mean where they differ; words that differ are counted."""
    if len(set(texts)) == 1:
        return texts[0]
    clauses = [text.split("; ") for text in texts]
    if len({len(clause) for clause in clauses}) > 1:
        return f"{texts[0]} (of the first of {len(texts)} members, whose texts differ)"
    return "; ".join(_clause([clause[k] for clause in clauses]) for k in range(len(clauses[0])))


def _clause(texts: Sequence[str]) -> str:
    found = [NUMBER.findall(text) for text in texts]
    words = [NUMBER.split(text) for text in texts]
    if len({len(numbers) for numbers in found}) > 1:
        return _counted(texts)
    merged = _counted([word[0] for word in words])
    for k in range(len(found[0])):
        merged += _number([numbers[k] for numbers in found]) + _counted([word[k + 1] for word in words])
    return merged


def _counted(words: Sequence[str]) -> str:
    """The words themselves, or what differs in them with how many members have each; what they begin and end with in
    common stands once."""
    counts = Counter(words)
    if len(counts) == 1:
        return words[0]
    begin = _whole_words(_common(list(counts)))
    rest = [word[len(begin) :][::-1] for word in counts]
    tail = _whole_words(_common(rest))[::-1]
    middle = [
        f"{word[len(begin) : len(word) - len(tail)].strip() or 'nothing'} ({count} of {len(words)})"
        for word, count in counts.most_common()
    ]
    return begin + " / ".join(middle) + tail


def _common(words: Sequence[str]) -> str:
    """What all of these texts begin with."""
    shortest = min(words, key=len)
    for k, letter in enumerate(shortest):
        if any(word[k] != letter for word in words):
            return shortest[:k]
    return shortest


def _whole_words(text: str) -> str:
    """The text up to its last space."""
    return text[: text.rfind(" ") + 1]


def _number(written: Sequence[str]) -> str:
    """With the most decimals that one of the texts has."""
    if len(set(written)) == 1:
        return written[0]
    merged = number([float(one) for one in written])
    powers = any("e" in one for one in written)
    decimals = max(len(one.partition(".")[2]) for one in written)
    form = ".3g" if powers else f".{decimals}f"
    if not np.isfinite(merged.mean):
        return written[0]
    return merged.text(form)
