"""Outputs that were removed or renamed while a partner read them, and which change did that."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

import pytest

from archgen.compare import Change
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.lost_connections import find_lost_connections, find_output_causes
from archgen.compare.matched_ids import MatchedIds
from tests.compare.conftest import Compared
from tests.compare.elements import by_key, element, pair
from tests.compare.losses.test_change_context import change, context
from tests.compare.losses.test_losses import PARTNERS, broken

SCREEN = (
    PARTNERS
    + """\
groups:
  sensing:
    owner: certh
    components:
      camera: {functionality: Sees what is there, outputs: {image: Colour image}}
      screen: {inputs: {image: camera.image}}
  tracking: {owner: sssa, components: {tracker: {inputs: {image: sensing.camera.image}}}}
"""
)
RENAMED = "renames what SSSA reads: `sensing.camera.image` is `{}` now; "
LEFT, FOLLOWED = "`tracking.tracker.image` has to follow", "files follow in this change"


@pytest.mark.parametrize(
    ("edits", "said"),
    [
        (
            [("camera: {", "eye: {"), ("{image: camera", "{image: eye")],
            f"sensing.eye sssa: {RENAMED.format('sensing.eye.image')}{LEFT}",
        ),
        ([("  sensing:\n", "  seeing:\n")], f"seeing sssa: {RENAMED.format('seeing.camera.image')}{LEFT}"),
        (
            [("  sensing:\n", "  seeing:\n"), ("sensing.camera", "seeing.camera")],
            f"seeing sssa: {RENAMED.format('seeing.camera.image')}{FOLLOWED}",
        ),
        ([("{image: camera.image}", "{title: Screen}")], ""),
    ],
)
def test_what_a_reader_does_not_follow(compared: Compared, edits: list[tuple[str, str]], said: str) -> None:
    assert broken(compared, SCREEN, edits) == ([said] if said else [])


def test_the_output_itself_is_the_cause_before_its_component_and_its_group() -> None:
    group, component = change("renamed", "group g"), change("moved", "component g.a")
    output, removal = change("renamed", "output g.a.x"), change("removed", "output g.gone.x")
    assert find_output_causes(context(group, component, output), "g.a.x") == [2]
    assert find_output_causes(context(group, component), "g.a.x") == [1]
    assert find_output_causes(context(component, group), "g.c.x") == [1]
    assert find_output_causes(context(component), "g.c.x") == []
    assert find_output_causes(context(output, removal), "g.gone.x") == [1]
    assert find_output_causes(context(change("changed", "output g.a.x", "type")), "g.a.x") == []


@pytest.mark.parametrize(
    ("lost", "said"),
    [
        ("", ["sssa takes `g.a.x` from SSSA (`g.b.i`)"]),
        ("other", ["sssa takes `g.a.x` from SSSA (`g.b.i`)"]),
        ("a", []),
    ],
)
def test_an_output_that_may_be_in_what_could_not_be_read_is_not_taken_away(lost: str, said: list[str]) -> None:
    reader = element("input g.b.i", owner="sssa")
    versions = pair(
        by_key(element("output g.a.x", owner="certh"), reader), by_key(reader), ("g.b.i <- g.a.x", ""), ("", lost)
    )
    removal = Change("removed", "output", "g.a.x")
    titled = replace(versions, partner_names={"sssa": "SSSA"})
    nothing = cast("Any", None)
    found = find_lost_connections(ChangeContext(nothing, nothing, MatchedIds(), titled, [removal]))
    assert [f"{loss.partner} {loss.reason}" for loss in found] == said


WATCH = """\
archgen: 1
partners: {certh: {title: CERTH}, sssa: {title: SSSA}, tum: {title: TUM}}
groups:
  watch:
    owner: certh
    autoconnect: ports
    components:
      beacon: {outputs: {beat: {type: Charge}}}
      listener: {owner: sssa, inputs: {beat: {type: Charge}}}
"""
RENAMED_BEACON = (
    "renames what SSSA reads: `watch.beacon.beat` is `deck.beacon.beat` now; `watch.listener.beat` has to follow"
)
TAKEN = "takes `watch.beacon.beat` from SSSA (`watch.listener.beat`); `autoconnect` joined them, and does no more"


@pytest.mark.parametrize(
    ("edits", "said"),
    [
        (
            [("      listener", "      beacon2: {outputs: {beat: {type: Charge}}}\n      listener")],
            [f"watch.beacon2 sssa: {TAKEN}"],
        ),
        (
            [("      listener", "      beacon2: {owner: tum, outputs: {beat: {type: Charge}}}\n      listener")],
            [f"watch.beacon2 sssa: {TAKEN}"],
        ),
        # Who adds the second one himself has to say which of them he reads.
        ([("      listener", "      beacon2: {owner: sssa, outputs: {beat: {type: Charge}}}\n      listener")], []),
        ([("    autoconnect: ports\n", "")], [f"watch.listener.beat sssa: {TAKEN}"]),
        ([("    owner: certh\n    autoconnect: ports\n", "    owner: sssa\n")], [f"watch.listener.beat sssa: {TAKEN}"]),
        # Moved out of the group.
        (
            [
                ("      beacon: {outputs: {beat: {type: Charge}}}\n", ""),
                (
                    "groups:\n",
                    "groups:\n  deck: {owner: certh, components: {beacon: {outputs: {beat: {type: Charge}}}}}\n",
                ),
            ],
            [f"watch.beacon sssa: {TAKEN}", f"watch.beacon sssa: {RENAMED_BEACON}"],
        ),
        # The reader's own doing.
        ([("inputs: {beat: {type: Charge}}", "inputs: {beat: {type: Level}}")], []),
        ([("inputs: {beat: {type: Charge}}", "inputs: {}")], []),
        (
            [
                ("    autoconnect: ports\n", ""),
                ("beat: {type: Charge}}}\n", "beat: {type: Charge, from: beacon.beat}}}\n"),
            ],
            [],
        ),
    ],
)
def test_a_connection_that_nobody_wrote_belongs_to_who_unmade_it(
    compared: Compared, edits: list[tuple[str, str]], said: list[str]
) -> None:
    assert broken(compared, WATCH, edits) == said


def test_a_group_of_the_readers_own_joins_what_it_likes(compared: Compared) -> None:
    own = WATCH.replace("owner: certh\n    auto", "owner: sssa\n    auto").replace(
        "beacon: {", "beacon: {owner: certh, "
    )
    assert broken(compared, own, [("    autoconnect: ports\n", "")]) == []


def test_who_reads_a_whole_group_loses_what_leaves_it(compared: Compared) -> None:
    crew = PARTNERS + (
        "groups:\n  yard: {owner: certh}\n"
        "  deck: {owner: certh, components: {lamp: {outputs: {light: Light}}, horn: {outputs: {sound: Sound}}}}\n"
        "  crew: {owner: sssa, components: {ear: {inputs: {signs: deck}}}}\n"
    )
    horn = "horn: {outputs: {sound: Sound}}"
    edits = [(f", {horn}", ""), ("yard: {owner: certh}", f"yard: {{owner: certh, components: {{{horn}}}}}")]
    told = "takes `deck.horn.sound` from SSSA (`crew.ear.signs`); it reads all of a group, in which that is no more"
    assert f"deck.horn sssa: {told}" in broken(compared, crew, edits)
