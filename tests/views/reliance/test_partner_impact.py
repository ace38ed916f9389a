"""What rests on a partner: chains, use cases, requirements, interfaces in their order, and what stands in for them."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

from archgen.products.agreement_documents import make_timed_lookup
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.lookup import Lookup
from archgen.views.reliance import partner_impact
from archgen.views.reliance.partner_impact import PartnerImpact, find_impact, find_parts_of, make_parts
from tests.judged_projects import judge_ramcip
from tests.late_robot import ROBOT, check


def look_up(folder: Path, text: str = ROBOT) -> Lookup:
    return make_timed_lookup(check(folder, text))


def impact_of(lookup: Lookup, partner: str) -> PartnerImpact:
    late = find_parts_of(lookup, lookup.architecture.partners[partner])
    return find_impact(lookup, gather_exchanges(lookup), late)


def test_a_chain_rests_on_a_partner_by_the_steps_that_are_his(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    north, south = impact_of(lookup, "north"), impact_of(lookup, "south")
    ((talk,), (half,)) = north.chains, south.chains
    # A chain without a deadline is none to miss.
    assert (talk.result.id, talk.own_steps, half.own_steps) == ("talk", 2, 1)
    whole = talk.result.bound.value
    assert talk.own_time.value is not None
    assert half.own_time.value is not None
    assert whole == talk.own_time.value + half.own_time.value > Fraction(0)
    assert impact_of(lookup, "west").free_chains == ("talk",)


def test_a_use_case_stops_at_the_first_step_that_needs_them(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    (case,) = impact_of(lookup, "south").use_cases
    assert (case.id, case.steps, case.stop) == ("UC-1", ("runs", "theirs", "theirs", "never"), 2)
    assert impact_of(lookup, "idle").use_cases == ()
    assert impact_of(lookup, "idle").use_case_count == 2


def test_requirements_come_with_who_else_serves_them_the_lonely_ones_first(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, ROBOT.replace("owner: south\n        requirements: [R-1, R-2]", "owner: south"))
    found = impact_of(lookup, "north").requirements
    assert [(each.requirement.id, each.others) for each in found] == [("R-1", ()), ("R-2", ())]
    # A chain through them serves it, too.
    assert [each.requirement.id for each in impact_of(lookup, "south").requirements] == ["R-2"]
    found = impact_of(look_up(tmp_path), "south").requirements
    assert [(each.requirement.id, [other.title for other in each.others]) for each in found] == [
        ("R-1", ["Eye"]),
        ("R-2", ["Mouth"]),
    ]


def test_interfaces_are_settled_by_deadlines_then_steps_then_readers(tmp_path: Path) -> None:
    given = impact_of(look_up(tmp_path), "south").interfaces
    assert [(each.terms[0].title, each.chains, each.use_case_steps, each.readers) for each in given] == [
        ("Brain · word", ("talk",), 1, ("g.mouth",)),
        ("Brain · ask", (), 0, ("g.log",)),
    ]
    assert [each.stand_in for each in given] == ["recording", "stub"]
    picture, odd = impact_of(look_up(tmp_path), "north").interfaces
    assert (picture.takers, picture.readers, odd.stand_in) == (("south", "west"), ("g.brain", "g.log"), "none")
    assert "message" in odd.open_words
    assert "message" not in picture.open_words


def test_what_gives_each_reader_something_is_counted_from_the_first(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    assert [impact_of(lookup, name).enough for name in ("north", "south", "west")] == [1, 2, 0]


def test_who_waits_says_what_runs_without(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    waiting = impact_of(lookup, "north").waiting
    assert [(each.id, each.flow_count, each.free_components) for each in waiting] == [
        ("south", 2, ()),
        ("west", 1, ("g.log",)),
    ]
    assert impact_of(lookup, "west").awaited == (("north", 1), ("south", 1))


def test_readers_are_those_of_the_flow_and_all_behind_them(tmp_path: Path) -> None:
    found = impact_of(look_up(tmp_path), "north")
    assert (found.readers, found.reached) == (("g.brain", "g.log"), 2)


def test_chosen_components_have_only_what_rests_on_them(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    found = find_impact(lookup, gather_exchanges(lookup), make_parts(lookup, ["g.mouth"]))
    assert found.interfaces == ()
    assert [each.own_steps for each in found.chains] == [1]
    assert found.awaited == (("south", 1),)
    unowned = find_impact(lookup, gather_exchanges(lookup), make_parts(lookup, ["g.bed"]))
    assert (unowned.readers, [each.id for each in unowned.use_cases]) == (("g.scale",), ["UC-2"])


def test_a_node_that_another_partner_writes_makes_its_component_his(tmp_path: Path) -> None:
    foreign = ROBOT.replace("brain: {implements: brain,", "brain: {implements: brain, owner: west,")
    lookup = look_up(tmp_path, foreign)
    assert partner_impact.find_parts_of(lookup, lookup.architecture.partners["west"]).components == {"g.log", "g.brain"}
    assert [each.own_steps for each in impact_of(lookup, "west").chains] == [1]


MILESTONES = """\
milestones:
  last: {needs: "owner:north"}
  second: {title: It talks, date: 2027-05-01, needs: "brain mouth"}
  first: {date: 2027-03-01, needs: eye}
"""


def test_milestones_that_need_them_come_by_their_days(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, ROBOT + MILESTONES)
    found = [(each.milestone.id, each.components) for each in impact_of(lookup, "north").milestones]
    assert found == [("first", ("g.eye",)), ("second", ("g.mouth",)), ("last", ("g.eye", "g.mouth"))]
    assert [each.milestone.id for each in impact_of(lookup, "south").milestones] == ["second"]
    assert impact_of(lookup, "west").milestones == ()


def test_until_a_day_only_what_comes_before_it_moves(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, ROBOT + MILESTONES)
    late = find_parts_of(lookup, lookup.architecture.partners["north"])
    for until, expected in (("2027-03-01", []), ("2027-03-02", ["first"]), ("2028-01-01", ["first", "second"])):
        found = find_impact(lookup, gather_exchanges(lookup), late, until=until)
        assert [each.milestone.id for each in found.milestones] == expected


def test_of_the_case_study_the_set_is_that_of_a_hand() -> None:
    lookup = make_timed_lookup(judge_ramcip())
    found = impact_of(lookup, "forth")
    assert sorted(found.free_chains) == ["contact_to_stop", "obstacle_to_stop", "slip_to_grip"]
    assert [each.terms[0].interface.key.rpartition(".")[2] for each in found.interfaces] == [
        "fall",
        "answers",
        "people",
        "activity",
        "gait",
        "skeletons",
        "identity",
        "utterance",
        "distress",
    ]
    assert [(each.id, each.flow_count) for each in found.waiting] == [
        ("certh", 9),
        ("tum", 6),
        ("lum", 2),
        ("sssa", 1),
        ("ace", 1),
    ]
    assert [each.stop for each in found.use_cases] == [7, 8, 2, 1, 1, 1, 1]
