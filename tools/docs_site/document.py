"""One Markdown file: its headings, links and formulas, and its HTML.

The dialect is CommonMark with tables, footnotes and formulas, as hosts of repositories draw it, so that a page looks
the same in the repository and in the site. Anchors of headings follow the same rule as there.
"""

import html
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from markdown_it import MarkdownIt
from markdown_it.token import Token
from mdit_py_plugins.dollarmath import dollarmath_plugin
from mdit_py_plugins.footnote import footnote_plugin
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_by_name, get_lexer_for_filename
from pygments.util import ClassNotFound

from docs_site.formulas import FormulaError, mathml, plain

MATH = ("math_inline", "math_inline_double", "math_block")
LINKS = {"link_open": "href", "image": "src"}
OURS = {"made by": "Document"}  # marks HTML that does not stand in the file
TABLE_ROW = re.compile(r"\|.*\|$", re.MULTILINE)
# Signs of Markdown that a reader would see, because the parser has found no meaning for them.
LEFT_OVER = {
    "$": "a $ outside code neither begins nor ends a formula",
    "](": "a link is not understood",
    "**": "a ** outside code neither begins nor ends bold text",
    "[^": "there is no such footnote",
}
# A line does not end before or after these blanks: "12 %", "3 ± 1".
TOGETHER = re.compile(r"(?<=\d) (?=%)|(?<=\d) (?=±)|(?<=±) (?=\d)")
LONG_CELL = 40  # letters of a table's cell that needs some width on a narrow screen
HTML_LINK = re.compile(r'\b(href|src)="([^"]*)"')
HTML_ANCHOR = re.compile(r'\b(?:id|name)="([^"]*)"')


@dataclass(frozen=True)
class Heading:
    level: int
    anchor: str
    text: str


@dataclass(frozen=True)
class Link:
    line: int
    href: str


def code_block(text: str, language: str, file: str = "") -> str:
    """The coloured block of a program text, as the theme expects it; a language that is not known has no colours. A
    text that nobody types, such as an output, has no button to copy it, which would hide the end of its first line."""
    try:
        lexer = get_lexer_for_filename(file) if file else get_lexer_by_name(language or "text")
    except ClassNotFound:
        lexer = get_lexer_by_name("text")
    coloured = highlight(text, lexer, HtmlFormatter(nowrap=True))
    kind = "highlight no-copy" if language == "text" else "highlight"
    return f'<div class="{kind}"><pre><span></span><code>{coloured}</code></pre></div>\n'


def _fence(_renderer: object, tokens: Sequence[Token], index: int, _options: object, _env: object) -> str:
    token = tokens[index]
    return code_block(token.content, token.info.strip().split(" ")[0])


def _parser() -> MarkdownIt:
    parser = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
    parser.use(dollarmath_plugin, allow_labels=False, allow_space=False, allow_digits=False, double_inline=True)
    parser.use(footnote_plugin)
    parser.add_render_rule("fence", _fence)
    parser.add_render_rule("code_block", _fence)
    return parser


def _source_text(tokens: Sequence[Token]) -> str:
    """The text of a heading with its formulas as they stand in the file, of which anchors are made."""
    return "".join(token.content for token in tokens if token.type in ("text", "code_inline", *MATH))


def _shown_text(tokens: Sequence[Token]) -> str:
    """The text of a heading as a reader sees it, after its formulas became MathML."""
    return "".join(
        plain(token.content) if token.meta == OURS else token.content
        for token in tokens
        if token.type in ("text", "code_inline") or token.meta == OURS
    )


class Document:
    """A parsed Markdown file. `problems` are sentences that begin with the file and the line."""

    def __init__(self, path: str, text: str):
        self.path = path
        self.problems: list[str] = []
        self.headings: list[Heading] = []
        self.anchors: set[str] = set()
        self.links: list[Link] = []
        self._parser = _parser()
        self._env: dict[str, object] = {}
        self._tokens = self._parser.parse(text, self._env)
        for index, token in enumerate(self._tokens):
            line = token.map[0] + 1 if token.map else 1
            source = _source_text(token.children or [])
            for part in [token, *(token.children or [])]:
                self._read(part, line)
            if index > 0 and self._tokens[index - 1].type == "heading_open":
                self._add_heading(self._tokens[index - 1], token, source)

    @property
    def title(self) -> str:
        return next((heading.text for heading in self.headings if heading.level == 1), self.path)

    def html(self, resolve: Callable[[str], str]) -> str:
        """The page's HTML; `resolve` turns the links of the repository into links of the site."""
        for before, token in pairwise([Token("", "", 0), *self._tokens]):
            if before.type == "td_open" and len(_shown_text(token.children or [])) > LONG_CELL:
                before.attrSet("class", "long")
            if [part.type for part in token.children or []] == ["image"]:
                self._open_on_click(token)
            for part in [token, *(token.children or [])]:
                if part.type in LINKS:
                    part.attrSet(LINKS[part.type], resolve(str(part.attrGet(LINKS[part.type]))))
                elif part.type == "text":
                    part.content = TOGETHER.sub("\u00a0", part.content)
                elif part.type in ("html_inline", "html_block") and part.meta != OURS:
                    part.content = HTML_LINK.sub(lambda found: f'{found[1]}="{resolve(found[2])}"', part.content)
        return self._parser.renderer.render(self._tokens, self._parser.options, self._env)

    def _open_on_click(self, paragraph: Token) -> None:
        """A picture alone leads to its file, where a reader with a narrow screen can make it larger."""
        picture = (paragraph.children or [])[0]
        opening = Token("link_open", "a", 1, attrs={"href": str(picture.attrGet("src"))})
        paragraph.children = [opening, picture, Token("link_close", "a", -1)]

    def _problem(self, line: int, sentence: str) -> None:
        self.problems.append(f"{self.path}:{line}: {sentence}")

    def _add_heading(self, opening: Token, content: Token, source: str) -> None:
        """Gives a heading its anchor: small letters, hyphens for blanks, no other signs, a number where it exists."""
        anchor = base = re.sub(r"[^\w\- ]", "", source.strip().lower()).replace(" ", "-")
        number = 0
        while anchor in self.anchors:
            number += 1
            anchor = f"{base}-{number}"
        self.anchors.add(anchor)
        self.headings.append(Heading(int(opening.tag[1]), anchor, _shown_text(content.children or [])))
        opening.attrSet("id", anchor)
        if opening.tag != "h1":
            sign = f'<a class="headerlink" href="#{anchor}" title="Link to this section">¶</a>'
            content.children = [*(content.children or []), Token("html_inline", "", 0, content=sign, meta=OURS)]

    def _read(self, token: Token, line: int) -> None:
        """Collects the links and anchors of a token, and turns formulas into MathML."""
        if token.type in LINKS:
            self.links.append(Link(line, str(token.attrGet(LINKS[token.type]))))
        elif token.type in MATH:
            self._convert(token, line)
        elif token.type in ("html_inline", "html_block") and token.meta != OURS:
            self.links += [Link(line, found[1]) for found in HTML_LINK.findall(token.content)]
            self.anchors.update(HTML_ANCHOR.findall(token.content))
        elif token.type == "text":
            for sign, sentence in LEFT_OVER.items():
                if sign in token.content and (sign != "$" or self.path.startswith("docs/")):
                    self._problem(line, sentence)
        elif token.type == "inline" and TABLE_ROW.match(token.content):
            self._problem(line, "the row of a table stands outside its table")

    def _convert(self, token: Token, line: int) -> None:
        display = token.type != "math_inline"
        latex = token.content
        try:
            token.content = mathml(latex, display)
        except FormulaError as error:
            self._problem(line, f"the formula {latex.strip()!r} is not understood: {error}")
            token.content = html.escape(latex)
        if display:
            token.content = f'<div class="formula">{token.content}</div>\n'
        token.type = "html_block" if token.type == "math_block" else "html_inline"
        token.meta = OURS
