"""What a partner has to do: every kind once, what most rests on first; whom he waits for, what others changed."""

from __future__ import annotations

from pathlib import Path

from archgen.products.agreement_documents import make_timed_lookup
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.reliance.partner_impact import find_impact, find_parts_of
from archgen.views.reliance.partner_tasks import PartnerTasks, find_tasks
from tests.late_robot import ROBOT, check


def tasks_of(
    folder: Path, partner: str, text: str = ROBOT, earlier: str = "", error_rules: tuple[str, ...] = ()
) -> PartnerTasks:
    checked = check(folder / "now", text, error_rules)
    lookup = make_timed_lookup(checked)
    exchanges = gather_exchanges(lookup)
    comparison = None
    if earlier:
        old = ProjectVersion("before", check(folder / "before", earlier))
        comparison = compare_named_versions(old, ProjectVersion("now", checked))
    impact = find_impact(lookup, exchanges, find_parts_of(lookup, lookup.architecture.partners[partner]))
    return find_tasks(lookup, exchanges, impact, comparison)


def texts_of(tasks: PartnerTasks, kind: str) -> list[str]:
    return [task.text for task in tasks.tasks if task.kind == kind]


def test_terms_are_owed_by_who_gives_and_awaited_by_who_takes(tmp_path: Path) -> None:
    north, south = tasks_of(tmp_path, "north"), tasks_of(tmp_path, "south")
    assert texts_of(north, "term") == [
        "State size and QoS offered of `g.eye.picture`",
        "State message, size and QoS offered of `g.eye.odd`",
    ]
    (picture, _) = (task for task in north.tasks if task.kind == "term")
    assert (picture.chains, picture.partners, picture.place.file) == (("talk",), ("south", "west"), "archgen.yaml")
    assert [terms.interface.key for terms in north.awaited] == ["g.brain.word"]
    assert [terms.interface.key for terms in south.awaited] == ["g.eye.picture", "g.eye.odd"]


def test_what_most_rests_on_comes_first_and_errors_before_it(tmp_path: Path) -> None:
    ranks = [(-len(t.chains), -len(t.requirements), -len(t.partners)) for t in tasks_of(tmp_path, "south").tasks]
    assert ranks == sorted(ranks)
    broken = ROBOT.replace("ask: brain.ask", "ask: brain.aks")
    first = tasks_of(tmp_path, "west", broken, "", ("unknown-reference",)).tasks[0]
    assert first.finding is not None
    assert (first.kind, first.finding.rule) == ("finding", "unknown-reference")


def test_a_chain_that_no_finding_is_about_is_of_who_takes_most_of_its_time(tmp_path: Path) -> None:
    found = {name: texts_of(tasks_of(tmp_path, name), "chain") for name in ("north", "south", "west")}
    assert found == {
        "north": [],
        "south": [
            "Show that `talk` meets its deadline: open · <= 179 ms left; execution time of log unknown",
            "Complete the figures of `look`: execution time of log unknown",
        ],
        "west": [],
    }
    late = ROBOT.replace("400 ms", "20 ms")
    tasks = tasks_of(tmp_path, "south", late)
    assert texts_of(tasks, "chain") == ["Complete the figures of `look`: execution time of log unknown"]
    assert [task.finding.rule for task in tasks.tasks if task.finding] == ["late-chain"]


def test_a_contradiction_is_of_both_sides(tmp_path: Path) -> None:
    clash = ROBOT.replace(
        "wcet: 5 ms}}", "wcet: 5 ms}, publishes: {picture: {qos: {reliability: best_effort}}}}"
    ).replace("wcet: 10 ms}}", "wcet: 10 ms}, subscribes: {see: {qos: {reliability: reliable}}}}")
    for name, other in (("north", "south"), ("south", "north")):
        tasks = tasks_of(tmp_path, name, clash, "", ("incompatible-qos",))
        (task,) = (each for each in tasks.tasks if each.kind == "contradiction")
        assert task.text.endswith("offers best effort only: nothing arrives.")
        assert task.partners == (other,)


def test_requirements_that_nothing_verifies_are_asked_for_where_others_are_verified(tmp_path: Path) -> None:
    lonely = ROBOT.replace("requirements: [R-1, R-2]", "requirements: [R-2]")
    assert texts_of(tasks_of(tmp_path, "north", lonely), "requirement") == []
    told = lonely.replace("R-3: {title: It waits}", "R-3: {title: It waits, verified_by: [UC-2]}")
    assert texts_of(tasks_of(tmp_path, "north", told), "requirement") == ["Say what verifies `R-1`"]
    # R-2 is served by two: it is on neither list.
    assert texts_of(tasks_of(tmp_path, "south", told), "requirement") == []


def test_activities_that_are_not_shown_in_time_stand_by_host(tmp_path: Path) -> None:
    busy = ROBOT + "hosts: {pc: {cores: 1}}\n"
    for name in ("eye", "brain", "mouth"):
        busy = busy.replace(f"{name}: {{implements: {name},", f"{name}: {{implements: {name}, host: pc,")
    busy = busy.replace("wcet: 10 ms", "wcet: 99 ms")
    found = [texts_of(tasks_of(tmp_path, name, busy), "host") for name in ("north", "south", "west")]
    assert any(found[0]) or any(found[1])
    assert found[2] == []
    assert all("on `pc`" in text and text.endswith(" due again") for texts in found for text in texts)


def test_planned_nodes_come_with_what_waits_for_them(tmp_path: Path) -> None:
    planned = ROBOT.replace("eye: {implements: eye,", "eye: {implements: eye, status: planned,")
    (eye,) = tasks_of(tmp_path, "north", planned).planned
    assert (eye.node.id, eye.chains, eye.partners) == ("eye", ("talk",), ("south", "west"))
    assert [each.node.id for each in tasks_of(tmp_path, "south", planned).planned] == []
    # A component that exists is not to be made, though nobody wrote its node yet.
    unwritten = ROBOT.replace("  eye: {implements: eye, timing: {period: 100 ms, wcet: 5 ms}}\n", "")
    for status, names in (("planned", ["eye"]), ("existing", [])):
        told = unwritten.replace("eye: {title: Eye,", f"eye: {{title: Eye, status: {status},")
        assert [each.node.id for each in tasks_of(tmp_path, "north", told).planned] == names


def test_what_others_changed_is_told_to_whom_it_concerns(tmp_path: Path) -> None:
    earlier = ROBOT.replace("Picture: sensor_msgs/msg/Image", "Picture: sensor_msgs/msg/CompressedImage")
    slower = ROBOT.replace("period: 100 ms", "period: 50 ms")
    assert tasks_of(tmp_path, "south").changes is None
    assert tasks_of(tmp_path, "south", ROBOT, ROBOT).changes == ()
    south = tasks_of(tmp_path, "south", ROBOT, earlier).changes
    assert south is not None
    assert any(text.startswith("breaks: ") and "Picture" in text for text in south)
    pace = tasks_of(tmp_path, "south", ROBOT, slower).changes
    assert pace is not None
    assert any("rate" in text and "eye.picture" in text for text in pace)
    # What is one's own is no news.
    own = tasks_of(tmp_path, "north", ROBOT, ROBOT.replace("wcet: 1 ms", "wcet: 2 ms")).changes
    assert own == ()
