"""Who is broken by which change: one table, each row a project and what is replaced in it."""

from __future__ import annotations

import pytest

from archgen.compare import Comparison
from tests.compare.conftest import Compared

PARTNERS = "partners: {certh: CERTH, sssa: SSSA, tum: TUM}\n"
GROUPS = """\
groups:
  sensing:
    owner: certh
    components:
      camera: {outputs: {image: Colour image, depth: Depth image}}
  tracking:
    owner: sssa
    components:
      tracker: {inputs: {image: camera.image}, outputs: {tracks: Tracks}}
"""
BASE = PARTNERS + GROUPS
TYPED = BASE + "types: {Colour image: sensor_msgs/msg/Image, Tracks: x_msgs/msg/Tracks}\n"
TAKEN = "takes `sensing.camera.image` from SSSA (`tracking.tracker.image`)"
TAKEN_WITH_READER = (
    "takes `sensing.camera.image` from SSSA (`tracking.tracker.image`); the same change takes the reader away"
)
RETYPED = (
    "gives `Grey image` instead of `Colour image` (the message stays `sensor_msgs/msg/Image`) "
    "as `sensing.camera.image`; `tracking.tracker.image` of SSSA reads it"
)
RENAMED = "renames what SSSA reads: `{}` is `{}` now; files follow in this change"
OUTPUT = ("image: Colour image, ", "")
DANGLING = ("image: camera.image", "image: ")

FUNCTIONS = {
    "an output that is read": (BASE, [OUTPUT, DANGLING], [f"sensing.camera.image sssa: {TAKEN}"]),
    "an output that nobody reads": (BASE, [(", depth: Depth image", "")], []),
    "an output that only its own partner reads": (BASE.replace("owner: sssa", "owner: certh"), [OUTPUT, DANGLING], []),
    "an output that is nobody's": (
        BASE.replace("owner: certh", "title: S"),
        [OUTPUT, DANGLING],
        [f"sensing.camera.image sssa: {TAKEN}"],
    ),
    "an output that somebody without a partner reads": (
        BASE.replace("owner: sssa", "title: T"),
        [OUTPUT, DANGLING],
        [],
    ),
    "an output that is optional to its reader": (
        BASE.replace("image: camera.image", "image: {from: camera.image, optional: true}"),
        [OUTPUT, ("from: camera.image, ", "")],
        [],
    ),
    "an output whose reader is taken away with it": (
        BASE,
        [OUTPUT, ("inputs: {image: camera.image}, ", "")],
        [f"sensing.camera.image sssa: {TAKEN_WITH_READER}"],
    ),
    "an output whose reader is taken away with all its component has": (
        BASE,
        [OUTPUT, ("tracker: {inputs: {image: camera.image}, outputs: {tracks: Tracks}}", "lamp: Lamp")],
        [f"sensing.camera.image sssa: {TAKEN_WITH_READER}"],
    ),
    "an output whose reader becomes optional with it": (
        BASE,
        [OUTPUT, ("image: camera.image", "image: {optional: true, external: Nothing}")],
        [f"sensing.camera.image sssa: {TAKEN}"],
    ),
    "an output that is retyped while its reader becomes optional": (
        BASE,
        [
            ("image: Colour image", "image: Grey image"),
            ("image: camera.image", "image: {from: camera.image, optional: true}"),
        ],
        [f"sensing.camera.image/type sssa: {RETYPED}"],
    ),
    "an output that is retyped while its reader gets another one": (
        BASE,
        [("image: Colour image", "image: Grey image"), ("image: camera.image", "image: camera.depth")],
        [f"sensing.camera.image/type sssa: {RETYPED}"],
    ),
    "an output that is retyped while its reader is taken away": (
        BASE,
        [("image: Colour image", "image: Grey image"), ("inputs: {image: camera.image}, ", "")],
        [f"sensing.camera.image/type sssa: {RETYPED}"],
    ),
    "an output whose reader gets another one": (
        BASE,
        [OUTPUT, ("camera.image", "camera.depth")],
        [f"sensing.camera.image sssa: {TAKEN}; it is to read `sensing.camera.depth` instead"],
    ),
    "a component with all it has": (
        BASE,
        [("camera: {outputs: {image: Colour image, depth: Depth image}}", "lamp: Lamp"), DANGLING],
        [f"sensing.camera sssa: {TAKEN}"],
    ),
    "an input": (BASE, [("inputs: {image: camera.image}, ", "")], []),
    "a reader that looks elsewhere": (BASE, [("camera.image", "camera.depth")], []),
    "an output that a new input has no use for": (
        BASE,
        [("{image: camera.image}", "{image: camera.image, more: }")],
        [],
    ),
    "a renamed output that its reader follows": (
        BASE,
        [("image: Colour", "picture: Colour"), ("camera.image", "camera.picture")],
        [f"sensing.camera.picture sssa: {RENAMED.format('sensing.camera.image', 'sensing.camera.picture')}"],
    ),
    "a renamed output that its reader does not follow": (
        BASE.replace("  tracking:", "      screen: {inputs: {picture: camera.image}}\n  tracking:"),
        [("image: Colour", "images: Colour"), ("picture: camera.image", "picture: camera.images")],
        [
            "sensing.camera.images sssa: renames what SSSA reads: `sensing.camera.image` is `sensing.camera.images` now; `tracking.tracker.image` has to follow"
        ],
    ),
    "a component in another group": (
        BASE.replace("  tracking:", "  eyes: {owner: certh, components: {lamp: Lamp}}\n  tracking:"),
        [
            ("      camera: {outputs: {image: Colour image, depth: Depth image}}\n", "      lens: Lens\n"),
            ("{lamp: Lamp}", "{lamp: Lamp, camera: {outputs: {image: Colour image, depth: Depth image}}}"),
        ],
        [f"eyes.camera sssa: {RENAMED.format('sensing.camera.image', 'eyes.camera.image')}"],
    ),
    "a conceptual type": (
        BASE,
        [("image: Colour image", "image: Grey image")],
        [
            (
                "sensing.camera.image/type sssa: gives `Grey image` instead of `Colour image` (the message stays `sensor_msgs/msg/Image`) "
                "as `sensing.camera.image`; `tracking.tracker.image` of SSSA reads it"
            )
        ],
    ),
    "a conceptual type that nobody reads": (BASE, [("Depth image", "Distances")], []),
    "a type that was not known": (
        BASE.replace("image: Colour image", "image: "),
        [("image: , ", "image: Colour image, ")],
        [],
    ),
    "a type that has another name everywhere": (TYPED, [("Colour image", "Picture")], []),
    "the message of a type": (
        TYPED,
        [("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")],
        [
            "Colour image/message sssa: gives `sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image` as `sensing.camera.image`; `tracking.tracker.image` of SSSA reads it"
        ],
    ),
    "the message of a type that nobody else reads": (TYPED, [("x_msgs/msg/Tracks", "y_msgs/msg/Tracks")], []),
    "an output that is taken while all partners are given up": (
        BASE,
        [OUTPUT, DANGLING, (PARTNERS, ""), ("owner: certh", "title: S"), ("owner: sssa", "title: T")],
        [
            f"sensing.camera.image sssa: {TAKEN}",
        ],
    ),
    "a hand-over to a third partner": (
        BASE,
        [("owner: certh", "owner: tum")],
        [],
    ),
    "a hand-over in another slice": (
        BASE,
        [("tracker: {inputs", "tracker: {owner: certh, inputs")],
        [],
    ),
    "a hand-over to the reader that takes something from him": (
        BASE,
        [("owner: certh", "owner: sssa"), OUTPUT, DANGLING],
        [
            f"sensing.camera.image sssa: {TAKEN}",
        ],
    ),
    "what was nobody's and has an owner now": (
        BASE.replace("owner: certh", "title: S"),
        [("title: S", "owner: certh")],
        [],
    ),
    "a further owner": (BASE, [("owner: certh", "owner: [certh, tum]")], []),
    "a partner with another id": (BASE, [("certh", "iti")], []),
}
SERVING = (
    PARTNERS
    + """\
use_cases: {UC-1: See, UC-2: Move}
requirements: {R-1: {title: One, use_cases: [UC-1]}, R-2: {title: Two, use_cases: [UC-1]}, R-3: {title: Three, use_cases: [UC-2]}}
groups:
  a: {owner: certh, components: {x: {title: X, requirements: [R-1, R-3]}, y: {title: Y, requirements: [R-1]}}}
  b: {owner: sssa, components: {z: {title: Z, requirements: [R-2]}}}
"""
)
TOLD = (
    BASE.replace("tracker: {inputs", "tracker: {outputs: {tracks: Tracks}, inputs").replace(
        ", outputs: {tracks: Tracks}}\n", "}\n"
    )
    + """\
  acting:
    owner: tum
    components:
      arm: {inputs: {tracks: tracker.tracks, stop: {external: Somebody presses}}}
use_cases:
  UC-1:
    actors: {who: Somebody}
    steps: [{from: camera, to: tracker}, {from: tracker, to: arm}, {from: who, to: arm}, {from: arm, to: camera}]
"""
)
CUT = "cuts step 1 of the use case `UC-1`; `tracking.tracker` of SSSA and `acting.arm` of TUM are part of it"
STEPS = {
    "a step whose output is gone": (
        TOLD,
        [OUTPUT, DANGLING],
        [
            f"sensing.camera.image sssa: {TAKEN}",
            f"sensing.camera.image sssa: {CUT}",
            f"sensing.camera.image tum: {CUT}",
        ],
    ),
    "a step whose reader turns away": (
        TOLD,
        [("tracks: tracker.tracks, ", "")],
        [
            "acting.arm.tracks certh: cuts step 2 of the use case `UC-1`; `sensing.camera` of CERTH and `tracking.tracker` of SSSA are part of it",
            "acting.arm.tracks sssa: cuts step 2 of the use case `UC-1`; `sensing.camera` of CERTH and `tracking.tracker` of SSSA are part of it",
        ],
    ),
    "a step that is dropped along with its connection": (
        TOLD,
        [("tracks: tracker.tracks, ", ""), ("{from: tracker, to: arm}, ", "")],
        [
            "acting.arm.tracks certh: cuts step 2 of the use case `UC-1`; `sensing.camera` of CERTH and `tracking.tracker` of SSSA are part of it",
            "acting.arm.tracks sssa: cuts step 2 of the use case `UC-1`; `sensing.camera` of CERTH and `tracking.tracker` of SSSA are part of it",
        ],
    ),
    "a step that goes over another component now": (
        TOLD,
        [
            (
                "arm: {inputs: {tracks: tracker.tracks",
                "new: {inputs: {t: tracker.tracks}, outputs: {u: Tracks}}\n      arm: {inputs: {tracks: new.u",
            ),
            ("{from: tracker, to: arm}", "{from: tracker, to: new}, {from: new, to: arm}"),
        ],
        [],
    ),
    "a step of which an end is called otherwise": (
        TOLD,
        [("camera", "front_camera")],
        [f"sensing.front_camera sssa: {RENAMED.format('sensing.camera.image', 'sensing.front_camera.image')}"],
    ),
    "a step that nobody from outside can take any more": (
        TOLD,
        [(", stop: {external: Somebody presses}", ", stop: ")],
        [
            "acting.arm.stop/external certh: cuts step 3 of the use case `UC-1`; `sensing.camera` of CERTH and `tracking.tracker` of SSSA are part of it",
            "acting.arm.stop/external sssa: cuts step 3 of the use case `UC-1`; `sensing.camera` of CERTH and `tracking.tracker` of SSSA are part of it",
        ],
    ),
}
REQUIREMENTS = {
    "a requirement that another component serves": (SERVING, [("[R-1, R-3]", "[R-3]")], []),
    "a requirement of a shared use case": (
        SERVING,
        [("[R-1, R-3]", "[R-3]"), ("Y, requirements: [R-1]", "Y")],
        [
            "a.x/requirements sssa: leaves `R-1` without a component, also for SSSA, who serves the same use case",
            "a.y/requirements sssa: leaves `R-1` without a component, also for SSSA, who serves the same use case",
        ],
    ),
    "a requirement of a use case of its own": (
        SERVING,
        [("[R-1, R-3]", "[R-1]")],
        [
            "a.x/requirements sssa: leaves `R-3` without a component, also for SSSA and TUM",
            "a.x/requirements tum: leaves `R-3` without a component, also for SSSA and TUM",
        ],
    ),
    "a requirement that is dropped itself": (
        SERVING,
        [("[R-1, R-3]", "[R-1]"), (", R-3: {title: Three, use_cases: [UC-2]}", "")],
        [],
    ),
}


@pytest.mark.parametrize(
    ("project", "edits", "said"),
    (FUNCTIONS | STEPS | REQUIREMENTS).values(),
    ids=(FUNCTIONS | STEPS | REQUIREMENTS).keys(),
)
def test_functions(compared: Compared, project: str, edits: list[tuple[str, str]], said: list[str]) -> None:
    assert broken(compared, project, edits) == said


def broken(compared: Compared, project: str, edits: list[tuple[str, str]]) -> list[str]:
    """Edit a project, and give what breaks whom: `element/key partner: why`."""
    after = project
    for old, new in edits:
        assert old in after, old
        after = after.replace(old, new)
    return told(compared(project, after))


def told(found: Comparison) -> list[str]:
    """Give what breaks whom."""
    return [
        f"{change.element_id}{f'/{change.key}' if change.key else ''} {each.partner}: {each.reason}"
        for change in found.changes
        for each in change.breaks
    ]


def test_hostile_types_stay_inside_their_ticks(compared: Compared) -> None:
    evil = r'"x` {} <b>[y](z)\n- # `"'
    found = broken(compared, BASE, [("image: Colour image", f"image: {evil}")])
    assert found == [
        (
            "sensing.camera.image/type sssa: gives `x' {} <b>[y](z) - # '` instead of `Colour image` as "
            "`sensing.camera.image`; `tracking.tracker.image` of SSSA reads it"
        )
    ]


def test_partners_who_lose_the_same_are_named_in_one_reason(compared: Compared) -> None:
    third = "  moving: {owner: tum, components: {planner: {inputs: {image: camera.image, more: camera.image}}}}\n"
    reason = (
        "takes `sensing.camera.image` from SSSA (`tracking.tracker.image`) and TUM (`moving.planner.image` and "
        "`moving.planner.more`)"
    )
    assert broken(compared, BASE + third, [OUTPUT]) == [
        f"sensing.camera.image {partner}: {reason}" for partner in ("sssa", "tum")
    ]


def test_partners_with_the_same_title_are_told_apart_by_their_ids(compared: Compared) -> None:
    twins = BASE.replace("sssa: SSSA, tum: TUM", "sssa: Twin, tum: Twin")
    taken = "takes `sensing.camera.image` from Twin (`sssa`) (`tracking.tracker.image`)"
    assert broken(compared, twins, [OUTPUT]) == [f"sensing.camera.image sssa: {taken}"]
