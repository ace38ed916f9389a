"""A made-up report of any size, with every shape in it and pictures that Graphviz draws. Shared by the tests of the Word report."""

from __future__ import annotations

import struct
import zlib
from dataclasses import replace
from functools import lru_cache

from archgen.emit.picture import Picture
from archgen.views.shapes import Bullets, Column, Facts, Figure, Markdown, Outline, Paragraph, Section, Table, Text

CHAPTER = """\
The robot helps **older people** at home. See [the risks](risks.md), the [project](https://example.org/a?b=c&d=[1]), or [a trap](javascript:alert).

# Scope

1. It recognises objects:
   - on *tables*,
   - on the `floor`.

     A second paragraph of the same item.
2. It brings them.

> A quotation
>
> of two paragraphs.

```yaml
groups:
  sensing: {title: Sensing}
```

![A red square](pictures/red.png "The square that every report has")

Words with ![small](pictures/red.png) a picture, ![lost](pictures/lost.png) a lost one, <b>HTML as text</b>.

| key | value |
|:----|------:|
| one | 1 |
| two | 2 |

7. A list that begins at seven
8. goes on

***

![A drawing](pictures/plan.svg)
"""
SVG = (
    b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100"><rect width="200" height="100" fill="#eef"/></svg>'
)


def png(width: int, height: int) -> bytes:
    """Make a red PNG."""
    rows = (b"\0" + b"\xb3\x26\x1e" * width) * height
    parts = (
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)),
        (b"IDAT", zlib.compress(rows)),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in parts
    )


FILES = {"docs/pictures/red.png": png(120, 60), "docs/pictures/plan.svg": SVG}


def drawn(name: str, dot: str) -> Picture:
    """Draw a picture as the real reports have them."""
    import pygraphviz

    graph = pygraphviz.AGraph(string=dot)
    graph.graph_attr["dpi"] = "72"
    graph.layout("dot")
    width, height = (float(side) for side in graph.graph_attr["bb"].split(",")[2:])
    svg = graph.draw(format="svg:cairo")
    graph.graph_attr["dpi"] = "150"
    return Picture(id=name, width=width + 8, height=height + 8, svg_outlines=svg, png=graph.draw(format="png"), dot=dot)


@lru_cache
def pictures() -> dict[str, Picture]:
    """Give a small picture, a wide one for a turned page, a tall one, and one that needs A3."""
    style = 'node [shape=box, fontname="DejaVu Sans", fontsize=9] edge [fontname="DejaVu Sans", fontsize=8]'
    chain = " ".join(f"n{n} -> n{n + 1} [label=data];" for n in range(9))
    fans = " ".join(f"a{n} -> b{n % 7};" for n in range(40))
    return {
        "small": drawn("small", f"digraph {{ rankdir=LR {style} camera -> recognition -> planner }}"),
        "wide": drawn("wide", f"digraph {{ rankdir=LR {style} {chain} }}"),
        "tall": drawn("tall", f"digraph {{ {style} {chain} }}"),
        "huge": drawn("huge", f"digraph {{ {style} {fans} }}"),
    }


def _text(value: str, **more: str | bool) -> tuple[Text, ...]:
    return (Text(value, **more),)  # type: ignore[arg-type] # the keys are Text's


def component(group: int, number: int) -> Section:
    """Give the section of one component, with figure, facts and tables."""
    name = f"Component {group}.{number} that tracks people"
    inputs = tuple(
        (
            _text(f"input_{row}", code=True),
            _text("Recognised objects", ref="type:objects"),
            (Text("from "), Text(f"component {row}", ref=f"component:g{group}.c{row + 1}")),
            _text(f"/environment_state/component_{number}/recognised_objects_{row}", code=True),
        )
        for row in range(4)
    )
    columns = (Column("Input"), Column("Type"), Column("Comes from", 2), Column("Topic", 2))
    table = Table(f"table:inputs.g{group}.c{number}", f"Inputs of {name}", columns, inputs)
    performance = Table(
        f"table:performance.g{group}.c{number}",
        f"Performance of {name}",
        (Column("Indicator", 2), Column("Accuracy"), Column("Execution time", align="right")),
        (
            (_text("Recall"), _text("90 % at 1 m"), _text("200 ms")),
            (_text("Precision"), _text("80 %"), _text("100 ms")),
        ),
    )
    said = "It finds persons in the room, tells them apart, and keeps track of where each of them goes. " * (
        1 + number % 3
    )
    return Section(
        f"component:g{group}.c{number}",
        name,
        (
            Markdown(said + "\n\n- first\n- second"),
            Facts(
                (
                    ("Owner", _text("CERTH-ITI")),
                    ("Role", _text("filter")),
                    ("Requirements", (Text("R-12", ref="requirement:R-12"),)),
                )
            ),
            Figure(
                f"figure:g{group}.c{number}",
                "small",
                f"{name} and its neighbours",
                "A camera feeds the recognition, which feeds the planner.",
            ),
            table,
            performance,
        ),
    )


def outline(groups: int = 3, components: int = 4) -> Outline:
    """Give a whole report."""
    sections = [
        Section("chapter:docs/introduction.md", "Introduction", (Markdown(CHAPTER, "docs", 1),)),
        Section(
            "overview",
            "Overview",
            (
                Paragraph((Text("All groups at a glance, see "), Text("the figure", ref="figure:huge"), Text("."))),
                Figure("figure:wide", "wide", "A wide picture turns the page", "A chain of ten boxes."),
                Figure("figure:huge", "huge", "All groups with their components", "Forty boxes feed seven."),
                Paragraph(_text("What stands after a large sheet.")),
                Figure("figure:tall", "tall", "A tall picture", "A chain of ten boxes, top to bottom."),
                Figure("figure:none", "none", "A picture that could not be drawn", "Nothing."),
                Bullets((_text("one"), (Text("two", strong=True), Text(" and more", muted=True))), ordered=True),
                Paragraph(_text("Mind this."), "note"),
                Paragraph(_text("Careful."), "warning"),
                Paragraph(_text("Wrong."), "error"),
            ),
        ),
        *(
            Section(
                f"group:g{g}",
                f"Group {g}",
                sections=tuple(component(g, c) for c in range(1, components + 1)),
                page_break=True,
            )
            for g in range(1, groups + 1)
        ),
        Section(
            "appendix:types",
            "Type mapping",
            (_wide(60),),
            (Section("type:objects", "Recognised objects"),),
            appendix=True,
            page_break=True,
        ),
        Section("appendix:open", "Open points", (Paragraph(_text("None.")),), appendix=True),
    ]
    facts = (
        ("Version", _text("1.0")),
        ("Revision", _text("3f2a91c")),
        ("Partners", (Text("CERTH-ITI"), Text("Scuola Superiore Sant'Anna", line_break=True))),
    )
    notices = (Paragraph(_text("Seven findings stand open."), "warning"),)
    return Outline("Architecture of a robot that helps", "Deliverable 3.2", facts, notices, tuple(sections))


def _wide(rows: int) -> Table:
    columns = tuple(Column(f"Column {n}", 1 + n % 3) for n in range(7))
    cells = tuple(tuple(_text(f"Row {row}, cell {n} with some words") for n in range(7)) for row in range(rows))
    anchors = tuple(f"requirement:R-{row}" for row in range(rows))
    return Table("table:types", "All types", columns, cells, anchors, wide=True)


def hostile() -> Outline:
    """Give a report of texts that break out of XML, fields, links and names, or that no XML can hold."""
    bad = "a<b>&\"'</w:t>]]>\x00\x08\x1b\ud800\udfff\ufffe\u202e \t\n{{title}} \u00e9\U0001f600 " + "x" * 400
    anchor = bad * 2
    inlines = (
        Text(bad, url='http://exa mple.org/<>"'),
        Text(bad, ref=anchor),
        Text(bad, url="javascript:alert(1)"),
        Text("", code=True),
        Text(bad, line_break=True),
    )
    urls = (
        "http://[::1",
        "https://",
        "https://user@host:99999999/%zz",
        "mailto:",
        "http://h/\ud800",
        "file:///etc/passwd",
        "https://é.org/é",
        "https://ok.org/a b|c",
    )
    links = tuple(Text(url, url=url) for url in urls)
    markdown = "\n\n".join(
        (
            bad,
            "> " * 40 + "deep",
            "- " * 40 + "deep",
            "|" + "a|" * 70 + "\n|" + "-|" * 70 + "\n|" + "b|" * 70,
            "# " + bad,
            "99999999999. x",
            "![a](../../etc/passwd)",
            "- ```\n  code",
            "[x][y]",
            "1.\n2.",
            "<script>",
        )
    )
    rows = ((inlines, links, ()), ((), (), ()))
    table = Table(anchor, bad, (Column(bad), Column("", 0), Column("z", -5)), rows, (anchor, "x"))
    blocks = (
        Paragraph(inlines),
        Paragraph(()),
        Markdown(markdown, "../..", 12),
        Bullets(((), inlines)),
        Facts(((bad, inlines), ("", ()))),
        table,
        table,
        Figure(anchor, bad, bad, bad),
        Figure(anchor, "small", bad, bad),
    )
    deep = Section("deep", bad, blocks)
    for level in range(12):
        deep = Section(f"level{level % 3}", bad, (), (deep,), appendix=level % 2 == 0)
    return Outline(
        bad,
        bad,
        ((bad, inlines), ("", ())),
        (Paragraph(inlines, "error"),),
        (deep, replace(deep, appendix=True)),
        language="x<y",
    )
