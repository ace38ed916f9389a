"""What the pages say: links, navigation, pictures, chapters; and what no text can make them say."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from html.parser import HTMLParser
from posixpath import dirname, join, normpath

import pytest

from archgen.emit.file_tree import FileTree
from archgen.emit.picture import Picture
from archgen.emit.site import build_site, site_navigation
from archgen.views.shapes import (
    Block,
    Bullets,
    Column,
    Dashboard,
    DashboardCard,
    Facts,
    Figure,
    KeyFigure,
    Markdown,
    Meter,
    Page,
    Paragraph,
    Section,
    Table,
    Text,
    Waterfall,
    WaterfallPiece,
    WaterfallStep,
)
from tests.quiet_seconds import measure_quiet_seconds

Draw = Callable[[str, dict[str, str]], Picture]


def page(*blocks: Block, title: str = "Start", sections: Sequence[Section] = ()) -> Page:
    section = Section("page:index", title, blocks, tuple(sections))
    return Page("index.html", "page:index", title, "overview", section)


def other(path: str = "groups/g.html", anchor: str = "group:g", title: str = "Sensing") -> Page:
    return Page(path, anchor, title, "groups", Section(anchor, title, ()), (("Overview", "page:index"),))


def tree_of(*pages: Page, pictures: dict[str, Picture] | None = None, title: str = "Robot") -> FileTree:
    return build_site(pages, pictures or {}, title=title, revision="1", notices=(), chapter_files=lambda _: None)


def body(tree: FileTree, path: str = "index.html") -> str:
    """Give what stands below a page's title."""
    html = tree.files[path].decode()
    return html[html.index("</h1>") + 6 : html.rindex("</main>")].strip()


def shown(*blocks: Block) -> str:
    return body(tree_of(page(*blocks), other()))


@pytest.mark.parametrize(
    ("run", "html"),
    [
        (Text("plain"), "plain"),
        (Text("Sensing", ref="group:g"), '<a href="groups/g.html">Sensing</a>'),
        (Text("nobody", ref="group:x"), "nobody"),
        (Text("here", ref="page:index"), "here"),
        (Text("a", code=True, strong=True, emphasis=True), "<em><strong><code>a</code></strong></em>"),
        (Text("x", muted=True, line_break=True), '<br><span class="muted">x</span>'),
        (Text("paper", url="https://e.org/?a=1&b=2"), '<a href="https://e.org/?a=1&amp;b=2">paper</a>'),
        (Text("mail", url="mailto:a@e.org"), '<a href="mailto:a@e.org">mail</a>'),
        (Text("evil", url="javascript:alert(1)"), "evil"),
        (Text("evil", url=" JavaScript:alert(1)"), "evil"),
        (Text("evil", url="data:text/html,x"), "evil"),
        (Text("evil", url="//e.org"), "evil"),
        (Text("<script>\"'&"), "&lt;script&gt;&quot;&#x27;&amp;"),
        (Text("{{7*7}}"), "{{7*7}}"),
        (Text("nul\x00 esc\x1b"), "nul\ufffd esc\ufffd"),
        (
            Text("environment_state.object_recognition", code=True),
            "<code>environment_<wbr>state.<wbr>object_<wbr>recognition</code>",
        ),
    ],
)
def test_runs_of_text(run: Text, html: str) -> None:
    assert shown(Paragraph((run,))) == f"<p>{html}</p>"


def test_what_stands_out_says_so_to_the_ear_too() -> None:
    assert shown(Paragraph((Text("Mind this."),), "warning")) == (
        '<p class="notice warning"><span class="spoken">Warning: </span>Mind this.</p>'
    )


def test_lists_and_facts() -> None:
    assert shown(Bullets(((Text("a"),),), ordered=True), Facts((("Owner", (Text("me"),)),))) == (
        '<ol>\n<li>a</li>\n</ol>\n<dl class="facts">\n<div><dt>Owner</dt><dd>me</dd></div>\n</dl>'
    )


def test_a_table_has_a_caption_widths_and_rows_with_anchors() -> None:
    columns = (Column("Name", 3), Column("Size", 1, "right"))
    table = Table("table:x", "Sizes", columns, (((Text("a"),), (Text("1"),)),), ("link:lan",))
    assert shown(table, Paragraph((Text("see", ref="link:lan"),))) == (
        '<div class="table narrow" id="table:x">\n<div class="scroll" role="group" tabindex="0" aria-label="Sizes">\n<table>\n'
        '<caption>Sizes</caption>\n<colgroup><col class="p75"><col class="p25"></colgroup>\n'
        '<thead><tr><th scope="col">Name</th><th scope="col" class="right">Size</th></tr></thead>\n<tbody>\n'
        '<tr id="link:lan"><td>a</td><td class="right">1</td></tr>\n</tbody>\n</table>\n</div>\n</div>\n'
        '<p><a href="#link:lan">see</a></p>'
    )


def test_a_state_is_a_chip_with_icon_word_and_margin() -> None:
    html = shown(Paragraph((Text("missed · +23.8 ms", status="missed"),)))
    assert re.sub(r"<svg.*?</svg>", "ICON", html) == (
        '<p><span class="chip missed">ICONmissed <span class="addition">+23.8 ms</span></span></p>'
    )
    assert 'class="chip not-proven"' in shown(Paragraph((Text("not proven", status="not proven"),)))
    assert "&lt;b&gt;" in shown(Paragraph((Text("<b> · <b>", status="open"),)))


@pytest.mark.parametrize(
    ("meter", "parts"),
    [
        (Meter(0.5, "met"), ['class="known" width="36"']),
        (Meter(0.5, "open", is_partial=True), ['class="hatch"', 'class="known" width="36"']),
        (Meter(1.5, "missed"), ['class="known" width="48"', 'class="over" x="48" width="24"', 'class="limit"']),
        (Meter(0, "met"), ['class="known" width="0"']),
    ],
)
def test_a_bar_shows_a_share(meter: Meter, parts: list[str]) -> None:
    html = shown(Paragraph((Text("", meter=meter),)))
    assert [part for part in parts if part not in html] == []
    assert html.count('class="') == len(parts) + 2
    assert 'aria-hidden="true"' in html


def test_a_dashboard_links_its_figures_and_cards() -> None:
    figure = KeyFigure("Chains", "7", "8", (Text("1 missed", status="missed"),), "group:g")
    lost = KeyFigure("Hosts", "1", "", (), "page:none")
    table = Table("t:1", "T", (Column("A"),), (((Text("x", ref="group:g"),),),))
    card = DashboardCard("Chains <b>", (table,), 8, "worst first", Text("All", ref="group:g"), "chains")
    start = replace(page(Paragraph((Text("below"),))), dashboard=Dashboard((figure, lost), (card,)))
    html = re.sub(r"<svg.*?</svg>", "", body(tree_of(start, other())))
    assert '<a class="figure" href="groups/g.html"><span class="title">Chains</span> <span class="value">7 ' in html
    assert '<div class="figure"><span class="title">Hosts</span> <span class="value">1</span>' in html
    assert '<section class="card w8 chains">\n<div class="head"><h2>Chains &lt;b&gt;</h2>' in html
    assert html.index("below") > html.index('<a href="groups/g.html">x</a>')


def test_the_tree_marks_pages_and_a_title_has_its_verdict() -> None:
    marked = replace(other(), mark="missed", verdict=(Text("missed", status="missed"),))
    html = tree_of(page(), marked).files["groups/g.html"].decode()
    assert '<span class="mark missed"><span class="spoken"> (a deadline is missed)</span></span>' in html
    assert '<div class="title"><h1>Sensing</h1> <span class="chip missed">' in html


def test_a_cell_with_a_quantity_has_the_exact_number_to_sort_by() -> None:
    row = ((Text("a"),), (Text("about "), Text("8.3 ms", sort_number="25000000/3")))
    html = shown(Table("t:1", "Times", (Column("Name"), Column("Time")), (row,)))
    assert '<td>a</td><td data-sort="25000000/3">about 8.3 ms</td>' in html


def test_sections_nest_and_are_listed_above() -> None:
    inner = Section("s:1", "One", (), (Section("s:2", "Two & more", ()),))
    html = body(tree_of(page(sections=(inner, Section("s:3", "Three", ())))))
    assert '<li><a href="#s:1">One</a></li>\n<li><a href="#s:3">Three</a></li>' in html
    assert '<section id="s:2">\n<h3>Two &amp; more</h3>' in html


def test_anchors_that_would_be_one_id_are_told_apart() -> None:
    sections = (Section("type:a b", "One", ()), Section("type:a-b", "Two", ()), Section("content", "Three", ()))
    html = body(tree_of(page(Paragraph((Text("x", ref="type:a-b"),)), sections=sections)))
    assert re.findall(r'<section id="([^"]*)"', html) == ["type:a-b", "type:a-b-2", "content-2"]
    assert '<a href="#type:a-b-2">x</a>' in html


def test_pages_whose_names_differ_in_case_only_both_exist() -> None:
    tree = tree_of(
        page(Paragraph((Text("b", ref="b"),))), other("types/Point.html", "a"), other("types/point.html", "b")
    )
    assert body(tree) == '<p><a href="types/point-2.html">b</a></p>'
    assert {"types/point.html", "types/point-2.html"} <= set(tree.files)


def test_a_path_never_leaves_the_site() -> None:
    tree = tree_of(page(), other("../../evil.html"))
    assert "evil.html" in tree.files


def test_the_tree_shows_where_the_reader_is() -> None:
    child = Page(
        "c.html",
        "c",
        "Camera",
        "components",
        Section("c", "Camera", ()),
        (("Overview", "page:index"), ("S", "group:g")),
    )
    html = tree_of(page(), other(), child).files["c.html"].decode()
    tree = html[html.index("<nav id") : html.index("</nav>")]
    assert '<li><a href="index.html">Overview</a></li>' in tree
    assert '<a href="groups/g.html">Sensing <span class="count" aria-hidden="true">1</span></a>' in tree
    assert '<li><a href="c.html" aria-current="page">Camera</a></li>' in tree
    assert (
        '<li><a href="index.html">Overview</a></li>\n<li><a href="groups/g.html">S</a></li>'
        in html[html.index("crumbs") :]
    )


def test_long_lists_are_not_repeated_on_each_page() -> None:
    parent = Page(
        "t.html", "page:t", "Topics", "spanning", Section("page:t", "Topics", ()), (("Overview", "page:index"),)
    )
    crumbs = (("Overview", "page:index"), ("Topics", "page:t"))
    topics = [Page(f"t/{i}.html", f"t:{i}", f"/t{i}", "topics", Section(f"t:{i}", "T", ()), crumbs) for i in range(61)]
    groups = [other(f"g/{i}.html", f"g:{i}", f"G{i}") for i in range(61)]
    tree = tree_of(page(), parent, *topics, *groups)
    for name, entries in (
        ("t/7.html", ["Overview", "All 61 on the start page", "Topics 61", "/t7"]),
        ("g/9.html", ["Overview", "G9", "60 more on the start page", "Topics 61"]),
    ):
        html = tree.files[name].decode()
        shown = html[html.index("<nav id") : html.index("</nav>")]
        assert [re.sub(r"<[^>]*>", "", entry) for entry in re.findall(r"<a .*?</a>", shown)] == entries
        assert shown.count("aria-current") == 1


def test_very_large_sites_show_long_lists_their_own_branch_of_the_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(site_navigation, "MAX_TREE_PAGES", 60)
    start = (("Overview", "page:index"),)
    spanning = [
        Page(f"{i}.html", f"page:{i}", f"S{i}", "spanning", Section(f"page:{i}", "S", ()), start) for i in range(3)
    ]
    crumbs = (*start, ("S1", "page:1"))
    topics = [Page(f"t/{i}.html", f"t:{i}", f"/t{i}", "topics", Section(f"t:{i}", "T", ()), crumbs) for i in range(61)]
    tree = tree_of(page(), *spanning, *topics, other())
    for name, entries in (
        ("t/7.html", ["Overview", "Sensing", "S1 61", "/t7", "2 more on the start page"]),
        ("2.html", ["Overview", "Sensing", "S0", "S1 61", "S2"]),
    ):
        html = tree.files[name].decode()
        shown = html[html.index("<nav id") : html.index("</nav>")]
        assert [re.sub(r"<[^>]*>", "", entry) for entry in re.findall(r"<a .*?</a>", shown)] == entries


def test_a_picture_stands_in_the_page_with_its_links(draw: Draw) -> None:
    picture = draw("a/b", {"group:g": "A & B".replace("&", "&amp;"), "nobody:x": "C"})
    tree = tree_of(page(Figure("figure:a", "a/b", "Cap", 'The "alt"')), other(), pictures={"a/b": picture})
    html = body(tree)
    assert '<svg width="347" height="59" class="archgen"' in html
    assert 'role="group" aria-label="The &quot;alt&quot;">' in html
    assert '<a href="groups/g.html"><title>A &amp; B</title>' in html
    assert "<g><title>C</title>" in html
    assert "#nobody" not in html
    assert "<!--" not in html
    assert re.findall(r'\sid="([^"]*)"', html) == ["figure:a"]
    assert '<a class="whole" href="figures/a/b.svg">' in html
    assert '<a href="../../groups/g.html">' in tree.files["figures/a/b.svg"].decode()


@pytest.mark.parametrize("target", ["javascript:alert(1)", "java&#115;cript:x", "//e.org/x", "data:x", "../../x"])
def test_a_picture_has_no_link_but_ours_and_the_webs(draw: Draw, target: str) -> None:
    svg = draw("x", {"T": "t"}).svg
    assert svg is not None
    picture = Picture("x", 1, 1, svg=svg.replace(b"#T", target.encode()))
    html = body(tree_of(page(Figure("figure:x", "x", "x", "")), pictures={"x": picture}))
    assert "<a " not in html.partition("<figcaption>")[0]


def test_a_picture_that_could_not_be_drawn_is_said(draw: Draw) -> None:
    picture = Picture("x", 1, 1, svg=draw("x", {}).svg, warning="Two flows are not shown.")
    tree = tree_of(page(Figure("f:1", "gone", "Gone", ""), Figure("f:2", "x", "X", "")), pictures={"x": picture})
    assert "This picture could not be drawn." in body(tree)
    assert '<p class="notice warning">Two flows are not shown.</p>' in body(tree)


def test_chapters(site: FileTree) -> None:
    html = body(site, "chapters/introduction.html")
    assert '<img src="../pictures/docs/img/robot.png" alt="The robot">' in html
    assert site.files["pictures/docs/img/robot.png"].startswith(b"\x89PNG")
    assert "<h2>Aims</h2>" in html
    assert "<h3>Deeper</h3>" in html
    assert '<a href="../chapters/risks.html">the risks</a>' in html
    assert '<a href="../components/g0.c0.html">a component</a>' in html
    assert "<span>nothing</span>" in html
    assert "evil" in html
    assert "javascript:" not in html.replace("[evil](javascript:alert(1))", "")
    assert "&lt;script&gt;alert(1)&lt;/script&gt; {{7*7}}" in html
    assert '<a href="https://example.org/x.png">from the web</a>' in html
    assert "[gone: not shown]" in html
    assert '<a href="https://example.org"><span class="muted">[badge: not shown]</span></a>' in html
    assert '<pre tabindex="0"><code>a block of code' in html
    assert '<div class="scroll" role="group" tabindex="0" aria-label="Table"><table>' in html
    assert '<td class="right">&lt;b&gt;</td>' in html


@pytest.mark.parametrize(
    "source", ["../../etc/passwd", "/etc/passwd", "C:/x", "..\\x", "file:///etc/passwd", "%2e%2e/%2e%2e/x"]
)
def test_a_chapter_asks_for_no_file_outside(source: str) -> None:
    asked: list[str] = []
    start = page(Markdown(f"![x](<{source}>)", "docs"))

    def files(path: str) -> bytes | None:
        asked.append(path)
        return None

    build_site((start,), {}, title="R", revision="", notices=(), chapter_files=files)
    assert all(not path.startswith(("/", "..")) for path in asked)


def test_a_picture_is_what_its_bytes_are() -> None:
    start = page(Markdown("![x](a.png) ![y](b.svg)", "docs"))
    files = {"docs/a.png": b"<html>", "docs/b.svg": b"<svg/>"}
    tree = build_site((start,), {}, title="R", revision="", notices=(), chapter_files=files.get)
    assert [path for path in tree.files if path.startswith("pictures/")] == ["pictures/docs/b.svg"]


def test_characters_that_html_forbids_are_shown_as_such() -> None:
    odd = "a\x00b\x1b\ud800c"
    sections = tuple(Section(name, odd, ()) for name in ("d", "e"))
    child = Page("c.html", "c", odd, odd, Section("c", odd, (), sections), ((odd, "page:index"),), odd)
    files = tree_of(page(title=odd), child, title=odd).files
    for path in ("index.html", "c.html"):
        assert not set("\x00\x1b") & set(files[path].decode())
    assert files["c.html"].decode().count("a\ufffdb\ufffd\ufffdc") == 11


HOSTILE = "</title><script>alert(1)</script>\"' {{7*7}} <img src=x onerror=alert(1)>"


def test_hostile_titles_stay_text(draw: Draw) -> None:
    table = Table("t:1", HOSTILE, (Column(HOSTILE),), (((Text(HOSTILE),),),))
    figure = Figure("f:1", "x", HOSTILE, HOSTILE)
    sections = tuple(Section(f"{HOSTILE}{i}", HOSTILE, (Paragraph((Text(HOSTILE, ref=HOSTILE),)),)) for i in range(2))
    start = page(
        table, figure, Facts(((HOSTILE, (Text(HOSTILE),)),)), Markdown(HOSTILE), title=HOSTILE, sections=sections
    )
    child = Page(
        f"{HOSTILE}.html", HOSTILE, HOSTILE, HOSTILE, Section(HOSTILE, HOSTILE, ()), ((HOSTILE, "page:index"),), HOSTILE
    )
    tree = build_site(
        (start, child),
        {"x": Picture("x", 1, 1, svg=draw("x", {}).svg, warning=HOSTILE)},
        title=HOSTILE,
        revision=HOSTILE,
        notices=(Paragraph((Text(HOSTILE),)),),
        chapter_files=lambda _: None,
    )
    for path, data in tree.files.items():
        if path.endswith(".html"):
            found = _Elements(data.decode())
            assert found.names["script"] == 3, path
            assert "img" not in found.names, path
            assert not any(name.startswith("on") for name in found.attributes), path


class _Elements(HTMLParser):
    def __init__(self, html: str) -> None:
        super().__init__()
        self.names: dict[str, int] = {}
        self.attributes: set[str] = set()
        self.links: list[str] = []
        self.ids: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.names[tag] = self.names.get(tag, 0) + 1
        for name, value in attrs:
            self.attributes.add(name)
            if name in {"href", "src"} and value:
                self.links.append(value)
            if name == "id" and value:
                self.ids.append(value)


def test_every_link_of_the_site_leads_somewhere(site: FileTree) -> None:
    read = {path: _Elements(data.decode()) for path, data in site.files.items() if path.endswith(".html")}
    for path, found in read.items():
        assert len(found.ids) == len(set(found.ids)), path
        for link in found.links:
            if link.startswith(("https://", "mailto:")):
                continue
            target, _, fragment = link.partition("#")
            file = normpath(join(dirname(path), target)) if target else path
            assert file in site.files, (path, link)
            assert not fragment or fragment in read[file].ids, (path, link)


def test_the_same_input_gives_the_same_bytes(made: Callable[[], FileTree], site: FileTree) -> None:
    assert made() == site


def test_a_site_of_a_real_size_takes_less_than_a_second(made: Callable[[], FileTree]) -> None:
    trees: list[FileTree] = []
    assert measure_quiet_seconds(lambda: trees.append(made())) < 1
    assert len([path for path in trees[0].files if path.endswith(".html")]) == 351


def test_a_waterfall_is_written_with_positions_in_percent_and_all_text_escaped() -> None:
    piece = WaterfallPiece("sampling", 0.0, 0.5, "waits <b>", is_cut=True)
    unknown = WaterfallPiece("unknown", 0.5, 1.0)
    step = WaterfallStep(Text("<s>"), (Text("P & Q"),), (piece, unknown), "waits <i>")
    card = DashboardCard("To do", (Bullets(((Text("this"),),)),), 12)
    waterfall = Waterfall(
        (Text("<lead>"),),
        (piece, unknown),
        ((0.0, "0"), (0.5, "5 s")),
        (1.0, 0.25),
        "deadline <10 s>",
        ((0.0, "0"), (0.5, "5 s")),
        (
            step,
            WaterfallStep(Text("early"), (), (WaterfallPiece("response", 0.1, 0.3),), "<= 4.2 %"),
            WaterfallStep(Text("late"), (), (WaterfallPiece("response", 0.9, 1.0),), "1 <b>"),
            WaterfallStep(Text("all"), (), (WaterfallPiece("response", 0.1, 1.0),), "9 %"),
        ),
        "short",
        (KeyFigure("At <b>", "5 s", "", (), ""),),
        (card,),
    )
    section = Section("page:index", "Start", ())
    page = Page("index.html", "page:index", "Start", "overview", section, waterfall=waterfall)
    tree = build_site([page], {}, title="T", revision="", notices=(), chapter_files=lambda _path: None)
    html = dict(tree.files)["index.html"].decode()
    for text in ("&lt;lead&gt;", "deadline &lt;10 s&gt;", "At &lt;b&gt;", "&lt;s&gt;", "P &amp; Q", "waits &lt;i&gt;"):
        assert text in html
    assert '<rect class="sampling" x="0%" width="50%" y="4" height="16"><title>waits &lt;b&gt;</title></rect>' in html
    # Short words stand at their bar; where that leaves no room, and longer ones, below it.
    assert '<text x="30%" dx="6" y="16">≤ 4.2 %</text></svg><p class=spoken>' in html
    assert '<text x="90%" dx="-6" y="16" text-anchor="end">1 &lt;b&gt;</text></svg><p class=spoken>' in html
    assert "</svg><p>9 %</p>" in html
    assert html.count('class="cut"') == 4
    assert html.count('id="waterfall-hatch"') == 1
    assert 'class="limit" x="25%"' in html
    assert "style=" not in html.partition("<main")[2]
