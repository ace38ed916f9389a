"""Pages on partners: who owes whom, each pair with what is promised beside what is derived, and each interface."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import pytest

from archgen.model.selector_evaluation import Selection
from archgen.pipeline import check_project
from archgen.products.project_views import list_signed_tags
from archgen.views.agreement import exchange_tables
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.agreement.interface_record import SignedTag
from archgen.views.lookup import DocumentScope, Lookup, make_lookup
from archgen.views.pages import partner_pages
from archgen.views.shapes import Facts, Inlines, Page, Paragraph, Table
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.repositories import git, repository

ROBOT = """\
ros: {distro: jazzy}
partners: {north: {title: North}, south: {title: South}, west: {title: West}}
types: {Picture: sensor_msgs/msg/Image, Odd: odd_msgs/msg/Odd}
groups:
  g:
    components:
      eye: {title: Eye, owner: north, outputs: {picture: Picture, odd: Odd}}
      brain: {title: Brain, owner: south, inputs: {see: eye.picture, feel: eye.odd}, outputs: {word: std_msgs/msg/String}}
      mouth: {title: Mouth, owner: north, inputs: {say: brain.word}}
      own: {title: Own, owner: north, inputs: {see: eye.picture}}
nodes:
  eye:
    implements: eye
    timing: {period: 100 ms}
    publishes: {picture: {qos: sensor_data}}
  brain: {implements: brain, timing: {behaviour: event, trigger: [see]}}
  mouth: {implements: mouth}
"""


def look_up(folder: Path, text: str = ROBOT, scope: DocumentScope | None = None) -> Lookup:
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    checked = check_project(folder / "robot.yaml")
    assert [f.message for f in checked.findings if f.severity == "error"] == []
    timing = analyse_with_chains(checked.architecture)
    return make_lookup(checked.architecture, checked.findings, scope, timing_lookup=timing)


def make_pages(lookup: Lookup) -> dict[str, Page]:
    return {page.anchor: page for page in partner_pages.make_partner_pages(lookup, tuple)}


def read(cell: Inlines) -> str:
    return "".join(("\n" if run.line_break else "") + run.text for run in cell)


def rows_of(table: object) -> list[list[str]]:
    assert isinstance(table, Table)
    return [[read(cell) for cell in row] for row in table.rows]


def test_promised_and_derived_stand_beside_each_other(tmp_path: Path) -> None:
    page = make_pages(look_up(tmp_path))["pair:north:south"]
    given = {section.anchor: section.blocks[0] for section in page.section.sections}
    picture, odd = rows_of(given["given:north"])
    assert picture[:2] == ["Picture\nEye → Brain", "sensor_msgs/msg/Image\n/g/eye/picture"]
    assert picture[2] == "10 Hz"
    assert picture[3:] == ["sensor data: best effort, depth 5", "size 1 contradiction"]
    assert odd[0] == "Odd\nEye → Brain"
    assert odd[-1].split() == ["size", "QoS", "fields"]
    (word,) = rows_of(given["given:south"])
    assert word[2] == "not promised"
    assert word[3] == "10 Hz"


def test_open_points_say_who_writes_them(tmp_path: Path) -> None:
    (exchange,) = gather_exchanges(look_up(tmp_path))
    rows = rows_of(exchange_tables.make_point_table(look_up(tmp_path), "t", exchange))
    (qos,) = (row for row in rows if row[0] == "QoS")
    assert qos[1:] == [
        "No quality of service is promised: ROS's default counts.\nOdd, std_msgs/msg/String",
        "North: 1\nSouth: 1",
    ]


def test_who_owes_whom_has_a_row_for_each_pair_with_interfaces(tmp_path: Path) -> None:
    pages = make_pages(look_up(tmp_path))
    (row,) = rows_of(pages["page:partners"].section.blocks[0])
    assert row[:3] == ["North and South", "2", "1"]
    assert "pair:north:west" not in pages


def test_each_interface_has_a_page_with_its_terms(tmp_path: Path) -> None:
    page = make_pages(look_up(tmp_path))["interface:g.eye.picture:north:south"]
    assert page.path == "partners/north/south/g.eye.picture.html"
    assert page.crumbs[-1] == ("North and South", "pair:north:south")
    assert page.lead == "Interface · North gives, South takes"
    assert any(isinstance(block, Table) and block.anchor.startswith("table:promises/") for block in page.section.blocks)


def test_the_page_of_an_interface_says_who_owns_and_who_reads_it_and_what_was_signed(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    tag = SignedTag("signed/north-south/1", "2026-03-31", "Ada", "Signed", "1a2b3c4")
    pages = {
        page.anchor: page for page in partner_pages.make_partner_pages(lookup, tuple, {("north", "south"): (tag,)})
    }
    facts = next(b for b in pages["interface:g.eye.picture:north:south"].section.blocks if isinstance(b, Facts))
    assert [(name, read(value)) for name, value in facts.rows[:3]] == [
        ("Owner", "North: Eye"),
        ("Readers", "South: Brain"),
        ("History", "1 signature of the agreement, the last on 2026-03-31 as signed/north-south/1"),
    ]
    assert facts.rows[3][0] == "Version"
    signed = pages["pair:north:south"].section.sections[-1]
    assert rows_of(signed.blocks[0]) == [["signed/north-south/1", "2026-03-31", "Ada", "1a2b3c4", "Signed"]]
    facts = next(
        b for b in make_pages(lookup)["interface:g.eye.picture:north:south"].section.blocks if isinstance(b, Facts)
    )
    assert read(facts.rows[2][1]) == "no signature of the agreement is recorded"


def test_above_a_limit_interfaces_have_no_pages_and_that_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(partner_pages, "MAX_INTERFACE_PAGES", 2)
    pages = make_pages(look_up(tmp_path))
    assert not any(anchor.startswith("interface:") for anchor in pages)
    notes = [read(b.inlines) for b in pages["pair:north:south"].section.blocks if isinstance(b, Paragraph)]
    assert "archgen interfaces --between north south" in notes[1]


def test_a_partner_sees_with_whom_it_has_interfaces(tmp_path: Path) -> None:
    pages = make_pages(look_up(tmp_path))
    tables = [block for block in pages["partner:south"].section.blocks if isinstance(block, Table)]
    assert rows_of(tables[0])[0][:3] == ["North", "1", "2"]
    assert not any(
        isinstance(b, Table) and b.anchor.startswith("table:exchanges") for b in pages["partner:west"].section.blocks
    )


@pytest.mark.parametrize(
    "text",
    [
        "groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {i: a.o}}}}}",
        "partners: {p: {}}\ngroups: {g: {components: {a: {owner: p, outputs: {o: std_msgs/msg/Bool}}, b: {owner: p, inputs: {i: a.o}}}}}",
    ],
)
def test_without_two_partners_there_is_nothing_to_owe(tmp_path: Path, text: str) -> None:
    assert not any(anchor.startswith(("page:", "pair:")) for anchor in make_pages(look_up(tmp_path, text)))


def test_a_part_shows_only_interfaces_with_an_end_in_it(tmp_path: Path) -> None:
    selection = Selection(frozenset({"g.mouth"}), frozenset({"mouth"}))
    lookup = look_up(tmp_path, scope=DocumentScope(selection.components, selection.nodes, "g.mouth"))
    (exchange,) = gather_exchanges(lookup)
    assert [terms.interface.key for terms in exchange.interfaces] == ["g.brain.word"]


def test_signatures_of_all_pairs_are_found_by_the_names_of_tags(tmp_path: Path) -> None:
    repository(tmp_path, {"robot.yaml": ROBOT})
    for name in ("signed/north-south/1", "signed/west-north/a", "signed/north-nobody/1", "signed/stray", "v1"):
        git(tmp_path, "tag", "-a", name, "-m", f"words of {name}")
    tags = list_signed_tags(check_project(tmp_path / "robot.yaml"))
    assert {pair: [tag.name for tag in found] for pair, found in tags.items()} == {
        ("north", "south"): ["signed/north-south/1"],
        ("north", "west"): ["signed/west-north/a"],
    }


def test_four_hundred_partners_are_not_joined_to_pairs_for_their_tags(tmp_path: Path) -> None:
    partners = "".join(f"p{number}: {{}}, " for number in range(400))
    repository(tmp_path, {"robot.yaml": f"archgen: 1\npartners: {{{partners}}}\n"})
    git(tmp_path, "tag", "-a", "signed/p399-p7/1", "-m", "words")
    checked_project = check_project(tmp_path / "robot.yaml")
    tracemalloc.start()
    tags = list_signed_tags(checked_project)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert list(tags) == [("p7", "p399")]
    assert peak < 5_000_000  # 80,000 pairs take four times that
