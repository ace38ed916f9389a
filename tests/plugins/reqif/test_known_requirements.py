"""Requirements that an earlier import brought are found again; relations in circles and several values are told."""

from __future__ import annotations

import time

from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.element_annotations import ElementAnnotations
from archgen.model.requirement import Requirement
from archgen.plugins.reqif.reqif_files import ReqifDocument, ReqifObject
from archgen.plugins.reqif.reqif_import import (
    KnownRequirements,
    cut_circles,
    find_known_requirements,
    make_identity_hints,
    take_requirements,
)


def known(*hints: object) -> KnownRequirements:
    return find_known_requirements(
        Requirement(f"R-{n}", "T", annotations=ElementAnnotations(hints={"reqif": each}), at=NO_SPAN)
        for n, each in enumerate(hints)
    )


def test_the_identifier_counts_before_the_id() -> None:
    found = known(
        {"identifier": "_a", "id": "SRS 1"}, {"identifier": "_b", "id": "SRS 2"}, {"id": 12}, "text", {"id": None}
    )
    assert found.find("_b", "SRS 1") == "R-1"
    assert found.find("_new", "SRS 1") == "R-0"
    assert found.find("_new", "12") == "R-2"
    assert found.find("", "") is None


def test_hints_say_no_more_than_is_needed() -> None:
    assert make_identity_hints("_a", "SRS-1", "SRS-1") == {"reqif": {"identifier": "_a"}}
    assert make_identity_hints("_a", "SRS 1", "SRS-1") == {"reqif": {"identifier": "_a", "id": "SRS 1"}}


def parents(**names: str) -> dict[str, dict[str, None]]:
    return {name: dict.fromkeys(text.split()) for name, text in names.items()}


def test_what_closes_a_circle_is_taken_out() -> None:
    way = parents(a="b", b="c x", c="a", d="b a")
    assert cut_circles(way) == (("c", "a"),)
    assert way == parents(a="b", b="c x", c="", d="b a")
    assert cut_circles(way) == ()
    two = parents(a="b", b="a", c="d", d="c")
    assert cut_circles(two) == (("b", "a"), ("d", "c"))


def test_a_long_way_takes_time_in_proportion() -> None:
    count = 50_000
    way = {f"n{n}": {f"n{n + 1}": None} for n in range(count)}
    way[f"n{count}"] = {"n0": None}
    begin = time.process_time()
    assert cut_circles(way) == ((f"n{count}", "n0"),)
    assert time.process_time() - begin < 20


def document(*entries: ReqifObject) -> ReqifDocument:
    names = {"i": "ReqIF.ForeignID", "p": "ReqIF.Prefix", "n": "ReqIF.Name", "k": "Priority", "t": "Tags"}
    names |= {"high": "High", "low": "Low, really"}
    return ReqifDocument(objects={each.id: each for each in entries}, names=names)


def entry(identifier: str, choices: dict[str, list[str]] | None = None, **values: str) -> ReqifObject:
    return ReqifObject(identifier, "", "f.reqif", 1, values={"n": "It stops", **values}, choices=choices or {})


def test_of_several_values_a_list_takes_all_and_a_word_the_first() -> None:
    taken = take_requirements(document(entry("_1", {"k": ["high", "low"], "t": ["low", "high", "low"]}, i="A-1")))
    body = taken.requirements["A-1"]
    assert (body["priority"], body["tags"]) == ("High", ["Low_really", "High"])
    assert [each.reason for each in taken.accounts] == ["its priority is `High`, not also `Low, really`"]


def test_a_prefix_keeps_the_blank_at_its_end() -> None:
    taken = take_requirements(
        document(entry("_1", i="12", p="SRS "), entry("_2", i="SRS 13", p="SRS "), entry("_3", i="on"))
    )
    assert list(taken.requirements) == ["SRS-12", "SRS-13", "R-on"]
    assert taken.requirements["SRS-12"]["hints"] == {"reqif": {"identifier": "_1", "id": "SRS 12"}}


def test_a_known_object_keeps_the_id_that_somebody_gave_it() -> None:
    taken = take_requirements(
        document(entry("_1", i="7"), entry("_2", i="8")), known({"identifier": "_2"}, {"id": "7"})
    )
    assert list(taken.requirements) == ["R-1", "R-0"]
