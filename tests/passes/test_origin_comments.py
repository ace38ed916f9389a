"""What an element was made from: in comments of the file, in findings, on cards, and through further passes."""

from __future__ import annotations

from pathlib import Path

from archgen.diagnostics.source_span import Span
from archgen.model.architecture import MadeElement, find_made_element
from archgen.passes.origin_comments import write_comment
from archgen.passes.patterns.pattern_registry import find_known_passes
from archgen.pipeline import check_project, transform_project
from archgen.views.elements.element_card import make_card
from archgen.views.lookup import make_lookup
from archgen.views.pages.page_parts import place_pages
from archgen.views.shapes import Page, Section
from tests.judged_projects import judge_shipped
from tests.passes.same_meaning import EXAMPLES, pack, write_project

MONITOR = ("groups", "cleaning", "components", "monitor")


def test_findings_in_what_a_pass_made_say_which_one_and_from_what(tmp_path: Path) -> None:
    transformed = transform_project(judge_shipped(EXAMPLES / "cleaning_robot"), ["monitor"])
    finding = next(each for each in transformed.findings if each.element == "cleaning.monitor")
    assert (finding.span.file, finding.span.line) == ("archgen.yaml", 90)
    assert [label.text for label in finding.labels] == ["made by the pass `monitor` from this"]
    file = tmp_path / "made.yaml"
    file.write_text(pack(transformed), encoding="utf-8")
    again = next(each for each in check_project(file).findings if each.element == "cleaning.monitor")
    assert again.span.file == "made.yaml"
    assert [label.text for label in again.labels] == ["made by the pass `monitor` from archgen.yaml:90:3"]


def test_cards_tell_the_way_back_and_further_passes_keep_it(tmp_path: Path) -> None:
    file = tmp_path / "flat.yaml"
    flat = transform_project(judge_shipped(EXAMPLES / "cleaning_robot"), ["flatten"])
    file.write_text(pack(flat), encoding="utf-8")
    checked = check_project(file)
    card = make_card(make_lookup(checked.architecture), "component", "cleaning.lidar")
    assert dict(card.facts)["origin"] == "made by the passes `complete_names` and `flatten` from archgen.yaml:102:22"
    assert pack(checked) == pack(flat)
    further = transform_project(checked, ["monitor"])
    assert "made[complete_names, flatten] from archgen.yaml:102:22" in pack(further)
    assert "monitor:  # archgen: made[monitor] from archgen.yaml:90:3" in pack(further)


def test_pages_of_the_site_tell_the_way_back() -> None:
    transformed = transform_project(judge_shipped(EXAMPLES / "cleaning_robot"), ["monitor"])
    lookup = make_lookup(transformed.architecture)
    section = Section("component:cleaning.monitor", "Monitor")
    page = Page("monitor.html", section.anchor, "Monitor", "component", section, lead="Component")
    (placed,) = place_pages(lookup, [page])
    assert placed.lead == "Component, made by the pass monitor from archgen.yaml:90:3"


def test_a_comment_beside_a_silenced_finding_keeps_both(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path,
        "component_types:\n  eye:\n    outputs: {seen: Pose} # archgen: ignore[unread-output] for later\n"
        "groups: {g: {components: {a: {is: eye}}}}\ntypes: {Pose: geometry_msgs/msg/Pose}\n",
    )
    transformed = transform_project(checked, ["resolve_instances"])
    assert "unread-output" not in {each.rule for each in transformed.findings}
    file = tmp_path / "packed" / "made.yaml"
    file.parent.mkdir()
    file.write_text(pack(transformed), encoding="utf-8")
    assert "unread-output" not in {each.rule for each in check_project(file).findings}


def test_comments_of_passes_that_are_rules_are_read(tmp_path: Path) -> None:
    checked = write_project(
        tmp_path, "component_types: {a: {functionality: X}}\ngroups: {g: {components: {r: {is: a}}}}\n"
    )
    known = find_known_passes(checked.loaded_project).passes
    transformed = transform_project(checked, ["rules.resolve_instances"], known)
    file = tmp_path / "packed" / "made.yaml"
    file.parent.mkdir()
    file.write_text(pack(transformed), encoding="utf-8")
    assert "made[rules.resolve_instances]" in pack(transformed)
    assert pack(check_project(file)) == pack(transformed)


def test_places_cannot_break_out_of_comments() -> None:
    made = MadeElement(("flatten",), "a\nb: {c: d} # archgen: ignore[x].yaml:1:2")
    comment = write_comment(made)
    assert "\n" not in comment
    assert "#" not in comment


def test_elements_are_found_by_their_place_or_their_line() -> None:
    made = {("a.yaml", 3, 7): MadeElement(("x",), "b:1:1"), ("a.yaml", 4, 0): MadeElement((), "b:2:1")}
    assert find_made_element(made, Span("a.yaml", 3, 7, 3, 9)) == MadeElement(("x",), "b:1:1")
    assert find_made_element(made, Span("a.yaml", 3, 8, 3, 9)) is None
    assert str(find_made_element(made, Span("a.yaml", 4, 2, 4, 9))) == "from b:2:1"
    assert find_made_element({}, Span("a.yaml", 4, 2, 4, 9)) is None
