"""One document of a comparison: terminal, Markdown and page say the same, in the same order and words."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare.breaking_changes import keep_breaking_only
from archgen.products import comparison_documents
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.changes.comparison_document import ComparisonDocument
from archgen.views.changes.comparison_outline import write_comparison_outline
from archgen.views.shapes import shape_to_plain

OLD = """\
archgen: 1
project: {id: robot}
partners: {certh: CERTH, sssa: SSSA}
groups:
  sensing:
    owner: certh
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      lamp: {title: Lamp, outputs: {light: Light}}
  display:
    owner: sssa
    components:
      screen: {title: Screen, inputs: {image: camera.image}}
chains: {see: {through: [camera, screen], deadline: 100 ms}}
"""
RETYPED = OLD.replace("msg/Image", "msg/CompressedImage")
REFUSED = "mend it, or SSSA says why it is right:"
MISSING = "sensing.camera.image: {key: type, was: a8601b, reason: THE REASON}"
FORMS = ("terminal", "markdown", "page")
Sides = tuple[ProjectVersion, ProjectVersion]
ReadSides = Callable[[str, str], Sides]


@pytest.fixture
def read_sides(tmp_path: Path) -> ReadSides:
    """Return a function that reads two one-file projects."""

    def read(old: str, new: str) -> Sides:
        sides = []
        for name, text in (("old", old), ("new", new)):
            (tmp_path / f"{name}.yaml").write_text(text, encoding="utf-8")
            sides.append(ProjectVersion(name, pipeline.check_project(tmp_path / f"{name}.yaml")))
        return sides[0], sides[1]

    return read


def describe(sides: Sides, *, only_breaking: bool = False) -> tuple[ComparisonDocument, dict[str, str]]:
    """Return the document of two versions, and what each format makes of it, without marks."""
    comparison = compare_named_versions(*sides)
    if only_breaking:
        comparison = keep_breaking_only(comparison)
    document = comparison_documents.describe_versions(comparison, *sides)
    outline = shape_to_plain(write_comparison_outline(document))
    return document, {
        "terminal": comparison_documents.render_comparison_text(comparison, *sides, colour=False).replace("`", ""),
        "markdown": comparison_documents.render_comparison_markdown(comparison, *sides)
        .replace("`", "")
        .replace("\\", "")
        .replace("&#8203;", "")
        .replace("**", ""),
        "page": " ".join(page_texts([outline["notices"], outline["sections"]])),
        "json": comparison_documents.render_comparison_json(comparison, *sides),
    }


def page_texts(data: object) -> list[str]:
    """Return the texts of an outline in their order; runs of one sentence are joined."""
    if isinstance(data, dict):
        key = {"section": "title", "markdown": "text"}.get(data.get("shape", ""))
        own_texts = [data[key]] if key else []
        return own_texts + [text for value in data.values() for text in page_texts(value)]
    if isinstance(data, list) and data and all(isinstance(item, dict) and item["shape"] == "text" for item in data):
        return ["".join(item["text"] for item in data)]
    return [text for item in data for text in page_texts(item)] if isinstance(data, list) else []


def test_all_formats_have_the_same_sections_in_the_same_order(read_sides: ReadSides) -> None:
    old = OLD.replace("      camera:", "      old_one: {outputs: {a: A}}\n      dim: {outputs: {b: B}}\n      camera:")
    new = RETYPED.replace("deadline: 100", "deadline: 90").replace(
        "      camera:", "      dim: {outputs: {b: B}}  # archgen: ignore[unread-output]\n      camera:"
    )
    new = new.replace("screen: {title: Screen, inputs: {", "screen: {title: Screen, inputs: {depth: , ")
    document, texts = describe(read_sides(old, new))
    assert [group.kind for group in document.finding_groups] == ["new", "silenced", "cured"]
    for form in FORMS:
        name = "Old One" if form == "page" else "old_one"
        headings = ["Breaking changes", name, "Latency of chains", "New findings", "Silenced findings"]
        headings.append("cured finding" if form == "markdown" else "Cured findings")
        start = texts[form].index("Breaking changes")
        places = [texts[form].index(heading, start) for heading in headings]
        assert places == sorted(places), form
        assert "Other changes" in texts[form] or form == "terminal"


def test_errors_of_reading_are_told_once(read_sides: ReadSides) -> None:
    document, texts = describe(read_sides(OLD, OLD.replace("image: camera.image", "image: camera.imag")))
    (error,) = document.after.errors
    assert error.rule == "unknown-reference"
    assert error not in [finding for group in document.finding_groups for finding in group.findings]
    for form in FORMS:
        assert texts[form].count(error.message.replace("`", "")) == 1, form
        assert "new is not sound (1 error). What cannot be read there is left out of the comparison:" in texts[form]
    data = json.loads(texts["json"])
    assert "unknown-reference" in {item["rule"] for item in data["findings"]["new"]}, "programs get all of it"


def test_findings_stand_gravest_first_in_every_format(read_sides: ReadSides) -> None:
    rules = "rules: {unread-output: error, unfed-input: note}\n"
    new = OLD.replace("inputs: {image: camera.image}", "inputs: {depth: , image: camera.image}")
    new = new.replace("chains:", "  more:\n    components:\n      last: {outputs: {x: X}}\nchains:")
    document, texts = describe(read_sides(OLD + rules, new + rules))
    findings = document.finding_groups[0].findings
    severities = [str(finding.severity) for finding in findings]
    assert severities == sorted(severities, key=["error", "warning", "note"].index)
    assert {"error", "note"} <= set(severities)
    assert [item["message"] for item in json.loads(texts["json"])["findings"]["new"]] == [f.message for f in findings]
    for form in FORMS:
        places = [texts[form].index(finding.message.replace("`", "")) for finding in findings]
        assert places == sorted(places), form


def test_a_refused_change_says_what_to_write_in_every_format(read_sides: ReadSides) -> None:
    strict = "review: {breaking: error, accepted: {sensing.lam: agreed}}\n"
    sides = read_sides(OLD + strict, RETYPED + strict)
    document, texts = describe(sides)
    assert document.refusal_help == REFUSED
    for form in FORMS:
        assert f"review.breaking: error refuses this: {REFUSED.replace('`', '')}" in texts[form], form
        assert "names no breaking change here" not in texts[form], form
        # Behind the change that it speaks of.
        name = "Camera · image" if form == "page" else "sensing.camera.image"
        places = [texts[form].index(part) for part in (f"as {name}", REFUSED, MISSING)]
        assert places == sorted(places), form
    _, texts = describe(sides, only_breaking=True)
    for form in FORMS:
        assert (
            "error: 1 breaking change for SSSA (wire); review.breaking: error refuses what is not accepted"
            in texts[form]
        )
        assert "names no breaking change here, and nothing in either version has this id" in texts[form], form
        assert REFUSED.replace("`", "") in texts[form], form


@pytest.mark.parametrize(
    ("new", "only_breaking", "headline"),
    [
        (OLD, False, "No change of the architecture"),
        (OLD, True, "No change breaks another partner"),
        (f"{OLD}types: [", False, "Cannot be judged: `new.yaml` cannot be read"),
        (OLD.replace("Lamp", "Torch"), False, "1 change of the architecture"),
    ],
)
def test_the_headline(read_sides: ReadSides, new: str, only_breaking: bool, headline: str) -> None:  # noqa: FBT001
    document, texts = describe(read_sides(OLD, new), only_breaking=only_breaking)
    assert document.headline == headline
    words = headline.replace("`", "")
    assert texts["markdown"].startswith(f"### {words}")
    assert (f"{words}." in texts["page"]) == document.is_empty
    if document.is_empty:
        sentence = (
            "no change breaks another partner" if only_breaking else document.obstacle.replace("`", "") or "no changes"
        )
        assert texts["terminal"].endswith(f"{sentence}\n")


def test_every_format_says_where_no_change_breaks_another_partner(read_sides: ReadSides) -> None:
    harmless = (
        OLD.replace("camera: {", "camera: {title: Eye, ", 1) if "camera: {" in OLD else OLD + "project: {version: 2}\n"
    )
    document, texts = describe(read_sides(OLD, harmless))
    assert document.all_clear == "no change breaks another partner"
    for form in FORMS:
        assert "o change breaks another partner" in texts[form], form
    _, broken_texts = describe(read_sides(OLD, RETYPED))
    assert [form for form in FORMS if "o change breaks another partner" in broken_texts[form]] == []
