"""What the site's search finds: one entry for each thing that has a name, or a text, of its own."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from archgen.diagnostics import Diagnostic
from archgen.frozen import dataclass
from archgen.views.lookup import Lookup
from archgen.views.shapes import Markdown, Page

_MARKS = re.compile(r"[*`#>|]+|\]\([^)]*\)|[\[\]]")


@dataclass(frozen=True, slots=True)
class SearchEntry:
    """One thing that a reader may look for.

    `kind` is a singular noun (`component`); `line` says what and whose it is. `refs` are anchors, the best first: the
    entry leads to the first that the site has, and is left out where it has none. `keys` are found as they are but not
    shown: ids, and selectors such as `owner:certh`. `text` is prose, which is searched last.
    """

    kind: str
    title: str
    line: str
    refs: tuple[str, ...]
    keys: tuple[str, ...] = ()
    text: str = ""

    @property
    def name(self) -> str:
        """The id of what it leads to, which may be what it belongs to; its title where that has none."""
        kind, _, name = self.refs[0].partition(":") if self.refs else ("", "", self.title)
        return name.partition("/")[2] if kind == "table" else name


def join_entry_parts(*parts: str | None) -> str:
    """Join the parts that are not empty to the second line of an entry."""
    return " · ".join(part for part in parts if part)


def to_plain_text(*texts: str | None) -> str:
    """Return Markdown texts on one line, without the marks that nobody types into a search."""
    return " ".join(_MARKS.sub(" ", " ".join(text for text in texts if text)).split())


_HEADING = re.compile(
    r"^ {0,3}#{1,6}[ \t]++(.*?)(?:(?<![ \t])[ \t]++)?+(?:(?<!#)#++)?+(?:(?<![ \t])[ \t]++)?+$", re.MULTILINE
)


def make_finding_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the findings, the most serious first."""
    for finding in sorted(lookup.findings, key=lambda finding: -finding.effective_severity.rank):
        yield _make_finding_entry(lookup, finding)


def _make_finding_entry(lookup: Lookup, finding: Diagnostic) -> SearchEntry:
    element = finding.element or ""
    port = lookup.architecture.inputs.get(element) or lookup.architecture.outputs.get(element)
    place = f"{finding.span.file}:{finding.span.line}" if finding.span.file else None
    return SearchEntry(
        "finding",
        to_plain_text(finding.message),
        join_entry_parts(finding.severity, place, finding.rule),
        (f"findings:{port.component if port else element}", "page:findings"),
        (f"finding:{finding.rule}",),
        to_plain_text(finding.help),
    )


def make_page_entries(pages: Iterable[Page], listed_anchors: frozenset[str]) -> Iterator[SearchEntry]:
    """Yield chapters, each with its headings, and the pages that no other entry leads to."""
    for page in pages:
        if page.kind == "chapters":
            # `split` gives what stands before the first heading, then heading and text in turns.
            opening, *rest = _HEADING.split(_page_text(page, raw=True))
            yield SearchEntry("chapter", page.title, "chapter", (page.anchor,), text=to_plain_text(opening))
            for heading, text in zip(rest[::2], rest[1::2], strict=True):
                line = join_entry_parts("chapter", page.title)
                yield SearchEntry("chapter", to_plain_text(heading), line, (page.anchor,), text=to_plain_text(text))
        elif page.anchor not in listed_anchors:
            yield SearchEntry("page", page.title, page.lead, (page.anchor,), text=_page_text(page))


def _page_text(page: Page, *, raw: bool = False) -> str:
    texts = [block.text for block in page.section.blocks if isinstance(block, Markdown)]
    return "\n\n".join(texts) if raw else to_plain_text(*texts)
