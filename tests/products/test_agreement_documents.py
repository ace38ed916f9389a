"""Agreements as files: Word, HTML and Markdown before their judges, and with texts that try to be more than text."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Sequence
from html.parser import HTMLParser
from pathlib import Path

import pytest
from lxml import etree
from markdown_it import MarkdownIt

import archgen
from archgen.products import agreement_documents
from archgen.products.agreement_documents import PartnersError
from archgen.products.compared_versions import read_version
from archgen.products.outline_markdown import render_outline_markdown
from archgen.products.output_options import OutputOptions
from archgen.views.agreement.partner_agreement import PartnerAgreement
from tests import hostile
from tests.agreeing import DUO, checked, written
from tests.emit.docx import inspection, judges
from tests.judged_projects import judge_ramcip
from tests.outside_tools import ask_nu_checker
from tests.property_sizes import try_some
from tests.repositories import commit, git, repository


def evil(text: str) -> dict[str, object]:
    """Give the hostile project with two partners, so that its connection is an interface."""
    data = hostile.project(text)
    data["partners"]["q"] = {**data["partners"]["p"], "reviewers": "@q/q"}
    data["groups"]["b"]["owner"] = "q"
    return data


KINDS = ("duo", "ramcip", *hostile.TEXTS)


@pytest.fixture(scope="module", params=KINDS)
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> PartnerAgreement:
    return make_agreement(request.param, tmp_path_factory.mktemp("agreement"))


def make_agreement(kind: str, folder: Path) -> PartnerAgreement:
    """Make the agreement of a small project, of the case study or of hostile texts."""
    if kind == "ramcip":
        return agreement_documents.make_project_agreement(judge_ramcip(), "sssa", "tum", None, "r1")
    if kind == "duo":
        earlier = read_version(
            None, written(folder / "before", DUO.replace("30 Hz", "20 Hz").replace("info: sensor", "x: sensor"))
        )
        return agreement_documents.make_project_agreement(checked(folder / "after"), "north", "south", earlier, "r1")
    found = checked(folder, hostile.written(evil(hostile.TEXTS[kind])))
    return agreement_documents.make_project_agreement(found, "p", "q", None, hostile.TEXTS[kind][:200])


class Page(HTMLParser):
    """Collects what is active in a page, or leads out of it."""

    def __init__(self) -> None:
        super().__init__()
        self.wrong: list[str] = []
        self.ids: list[str] = []
        self.targets: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Judge a tag and its attributes."""
        values = {name: value or "" for name, value in attrs}
        if tag in {"script", "iframe", "object", "embed", "link", "img", "form", "base", "image"}:
            self.wrong.append(tag)
        self.wrong += [f"{tag} {name}" for name in values if name.startswith("on")]
        self.ids += [values["id"]] if "id" in values else []
        address = values.get("href", values.get("xlink:href", ""))
        if address.startswith("#"):
            self.targets.append(address[1:])
        elif address and not re.match(r"(https?:|mailto:)", address):
            self.wrong.append(f"{tag} {address}")


def test_the_page_stands_by_itself(made: PartnerAgreement) -> None:
    html = agreement_documents.render_agreement_html(made, OutputOptions()).decode()
    page = Page()
    page.feed(html)
    page.close()
    assert page.wrong == []
    assert len(set(page.ids)) == len(page.ids)
    assert set(page.targets) <= set(page.ids)
    addresses = re.findall(r"url\(([^)]{0,20})", html)
    assert addresses
    assert all(address.startswith("data:") for address in addresses)
    assert "default-src 'none'" in html
    assert "This picture could not be drawn" not in html


_UNKNOWN_TO_CHECKER = {
    *(f"CSS: “{name}”: Property “{name}” doesn't exist." for name in ("rx", "container-type")),
    "CSS: Unrecognized at-rule “@container”",
}
"""What the checker says of CSS that browsers know: of SVG 2 (7.4), and of container queries."""


def judge_pages(pages: Sequence[Path]) -> list[str]:
    """Return what the Nu checker says against pages, of all at once: Java takes longer to begin than to read one."""
    messages = [
        m
        for m in ask_nu_checker(pages)
        # Texts need not be in Unicode's NFC.
        if m["type"] == "error" and m["message"] not in _UNKNOWN_TO_CHECKER
    ]
    return [f"{m.get('url')}:{m.get('lastLine')}: {m['message']}" for m in messages]


@pytest.mark.slow
def test_the_nu_checker_finds_nothing(tmp_path: Path) -> None:
    pages = [tmp_path / f"{kind}.html" for kind in KINDS]
    for page in pages:
        agreement = make_agreement(page.stem, tmp_path / page.stem)
        page.write_bytes(agreement_documents.render_agreement_html(agreement, OutputOptions()))
    assert judge_pages(pages) == []


def test_the_nu_checker_finds_a_fault_on_any_page(tmp_path: Path) -> None:
    for name, body in (("sound", "<p>a</p>"), ("faulty", "<p id=a>a</p><p id=a>b</p>")):
        page = f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>T</title></head><body>{body}</body></html>'
        (tmp_path / f"{name}.html").write_text(page, encoding="utf-8")
    (said,) = judge_pages([tmp_path / "sound.html", tmp_path / "faulty.html"])
    assert "faulty.html:1: Duplicate ID" in said


@pytest.mark.parametrize("made", try_some(["markup", *(kind for kind in KINDS if kind != "markup")]), indirect=True)
def test_word_opens_it(made: PartnerAgreement, tmp_path: Path) -> None:
    file = tmp_path / "a.docx"
    agreement_documents.write_agreement(made, "docx", file)
    assert inspection.faults(file.read_bytes()) == []
    assert judges.validated(file) == []
    with zipfile.ZipFile(io.BytesIO(file.read_bytes())) as package:
        relations = [etree.fromstring(package.read(name)) for name in package.namelist() if name.endswith(".rels")]
    outside = [r.get("Target", "") for part in relations for r in part if r.get("TargetMode") == "External"]
    assert {target.partition(":")[0] for target in outside} <= {"https", "http"}


def test_markdown_holds_nothing_active(made: PartnerAgreement) -> None:
    text = render_outline_markdown(made.outline, (made.graph,))
    assert not re.search(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]", text)
    html = MarkdownIt("commonmark", {"html": True}).enable("table").render(text)
    page = Page()
    page.feed(html)
    page.close()
    assert page.wrong == []
    assert set(page.targets) <= set(page.ids)
    tables = [line for line in text.splitlines() if line.startswith("|")]
    assert tables
    rows = re.findall(r"<tr>(.*?)</tr>", html, re.DOTALL)
    assert len(rows) == sum(not set(line) <= set("| -:") for line in tables), "every row is a row of a table"


def test_the_same_bytes_again(made: PartnerAgreement) -> None:
    assert agreement_documents.render_agreement_html(
        made, OutputOptions()
    ) == agreement_documents.render_agreement_html(made, OutputOptions())
    assert agreement_documents.render_agreement_docx(
        made, OutputOptions()
    ) == agreement_documents.render_agreement_docx(made, OutputOptions())


def test_since_a_revision(tmp_path: Path) -> None:
    folder = repository(tmp_path / "duo", {"archgen.yaml": DUO})
    first = git(folder, "rev-parse", "HEAD")
    commit(folder, {"archgen.yaml": DUO.replace("rate: 30 Hz", "rate: 25 Hz")})
    (folder / "archgen.yaml").write_text(DUO.replace("rate: 30 Hz", "rate: 20 Hz"), encoding="utf-8")
    project = archgen.load(folder)
    target = tmp_path / "out" / "a.md"
    project.write_agreement(target, "north", "south", since="HEAD~1")
    text = target.read_text(encoding="utf-8")
    assert f"- **Changes since:** HEAD\\~1 ({first[:7]})" in text
    assert "| Rate (promised) | \\~ changed | 30 Hz · 33.333 ms | 20 Hz · 50 ms |" in text
    project.write_agreement(target, "north", "south", since=first)
    assert f"- **Changes since:** {first}\n" in target.read_text(encoding="utf-8")


def test_an_earlier_state_with_errors_is_said_and_compared_as_far_as_it_is_sound(tmp_path: Path) -> None:
    earlier = read_version(
        None, written(tmp_path / "a", DUO.replace("inputs: {image: camera.image, p", "inputs: {image: camra.image, p"))
    )
    found = agreement_documents.make_project_agreement(checked(tmp_path / "b"), "north", "south", earlier, "")
    said = ["".join(run.text for run in notice.inlines) for notice in found.outline.notices]
    assert said[0].startswith("The architecture at the working tree has errors (1 error")


def test_a_partner_who_is_new_has_only_what_was_added(tmp_path: Path) -> None:
    without = DUO.replace("owner: south", "owner: north").replace("[north, south]", "north")
    without = re.sub(r"  south: .*\n", "", without)
    found = agreement_documents.make_project_agreement(
        checked(tmp_path / "b"), "north", "south", read_version(None, written(tmp_path / "a", without)), ""
    )
    assert found.changes is not None
    assert len(found.changes.added_keys) == found.interface_count == 3


@pytest.mark.parametrize(
    ("first", "second", "said"),
    [
        ("north", "sout", "there is no partner `sout`; did you mean `south`?"),
        ("nobody", "south", "there is no partner `nobody`; there are north, south, west"),
        ("south", "south", "an agreement is between two partners, and `south` was given twice"),
        (
            "west",
            "south",
            "nothing flows between `west` and `south`: `west` owns no component and no node",
        ),
    ],
)
def test_partners_without_an_agreement(tmp_path: Path, first: str, second: str, said: str) -> None:
    project = checked(tmp_path, DUO.replace(", owner: west", ""))
    with pytest.raises(PartnersError, match=re.escape(said)):
        agreement_documents.make_project_agreement(project, first, second)


def test_partners_who_have_interfaces_with_others(tmp_path: Path) -> None:
    with pytest.raises(PartnersError) as refused:
        agreement_documents.make_project_agreement(checked(tmp_path), "west", "south")
    assert str(refused.value) == (
        "nothing flows between `west` and `south`; `west` has interfaces with north; `south` has interfaces with north"
    )


def test_a_project_without_partners(tmp_path: Path) -> None:
    text = "archgen: 1\ngroups: {a: {components: {x: {outputs: {o: T}}}}}\n"
    with pytest.raises(PartnersError, match="the project has no partners: declare them below `partners`"):
        agreement_documents.make_project_agreement(checked(tmp_path, text), "a", "b")


SHARED_CHAIN = """
archgen: 1
project: {id: two, title: Two}
partners: {north: North Robots, south: South Vision}
groups:
  g:
    components:
      scan: {outputs: {out: Data}, owner: north}
      last: {inputs: {i: scan.out}, owner: south}
      beside: {outputs: {out: Other}, owner: south}
nodes:
  scan: {implements: scan, host: p, timing: {rate: 10 Hz, wcet: 1 ms}}
  last: {implements: last, host: p, timing: {wcet: 20 ms}}
  beside: {implements: beside, host: p, timing: {period: 1 s, wcet: 9 ms}}
hosts: {p: {cores: 1}}
types: {Data: std_msgs/msg/Empty, Other: std_msgs/msg/Bool}
chains: {c: {title: See and stop, through: [scan, last], deadline: 150 ms}}
"""


@pytest.mark.parametrize(
    ("deadline", "table"),
    [
        (
            ", deadline: 150 ms",
            [
                ("See and stop<br>150 ms in all, all times 1.666", "North Robots", "`scan`", "1 ms", "1.666 ms"),
                ("", "South Vision", "`last`", "20 ms", "33.32 ms"),
            ],
        ),
        ("", []),
    ],
)
def test_who_may_take_how_much_stands_in_the_agreement(
    tmp_path: Path, deadline: str, table: list[tuple[str, ...]]
) -> None:
    project = checked(tmp_path, SHARED_CHAIN.replace(", deadline: 150 ms", deadline))
    agreement = agreement_documents.make_project_agreement(project, "north", "south", None, "r1")
    page = render_outline_markdown(agreement.outline, (agreement.graph,))
    _, is_there, rest = page.partition("**Who may take how much**\n")
    assert bool(is_there) == bool(table)
    rows = [line for line in rest.partition("<a id")[0].splitlines() if line.startswith("| ")][2:]
    assert [tuple(cell.strip() for cell in row.strip("|").split("|")) for row in rows] == table
