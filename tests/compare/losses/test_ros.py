"""What breaks other partners' programs: names, quality of service, definitions of messages."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared
from tests.compare.losses.test_losses import BASE, broken
from tests.property_sizes import try_some

NODES = (
    BASE
    + """\
types: {Colour image: sensor_msgs/msg/Image, Depth image: sensor_msgs/msg/Image}
nodes:
  eye: {implements: camera, publishes: {image: {topic: /eye/image, qos: {reliability: reliable, deadline: 50 ms}}}}
  mind: {implements: tracker, subscribes: {image: {qos: {reliability: reliable}}}}
"""
)
FOLLOWED = "{0} sssa: renames what SSSA reads: `sensing.camera.image` is `{0}.image` now; files follow in this change"
RENAMED = "takes the topic `/eye/image` from SSSA (`mind`); it is `{}` now"
DERIVED = NODES.replace("topic: /eye/image, ", "")
FEWER = ("reliability: reliable, deadline: 50 ms", "reliability: best_effort, deadline: 50 ms")
UNHEARD = (
    "offers best effort only on `/eye/image`, where `mind` of SSSA asks for reliable delivery: nothing arrives any more"
)
# Both outputs on one topic, of which the reader reads one.
SHARED = NODES.replace(
    "image: {topic: /eye/image, qos: {reliability: reliable, deadline: 50 ms}}",
    "image: {topic: /eye/all}, depth: {topic: /eye/all}",
).replace("image: camera.image", "image: camera.depth")
INTERNAL = (
    BASE
    + """\
nodes:
  eye: {implements: camera, internal: {publishes: {state: {topic: /s, message: std_msgs/msg/String, qos: {reliability: reliable}}}}}
  mind: {implements: tracker, internal: {subscribes: {state: {topic: /s, message: std_msgs/msg/String, qos: {reliability: reliable}}}}}
"""
)
NAMES = {
    "a topic": (NODES, [("/eye/image", "/eye/rgb")], ["eye.publishes.image/topic sssa: " + RENAMED.format("/eye/rgb")]),
    "a topic of another reader's of one's own": (
        NODES.replace("owner: sssa", "owner: certh"),
        [("/eye/image", "/eye/rgb")],
        [],
    ),
    "a topic that nobody reads yet": (
        NODES,
        [("deadline: 50 ms}}}", "deadline: 50 ms}}, depth: {topic: /eye/depth}}")],
        [],
    ),
    "a topic whose reader is only planned": (
        NODES.replace("mind: {", "mind: {status: planned, "),
        [("/eye/image", "/eye/rgb")],
        [],
    ),
    "a topic whose reader is not even planned": (NODES[: NODES.index("  mind:")], [("/eye/image", "/eye/rgb")], []),
    "a namespace that the name rests on": (
        NODES.replace("/eye/image", "image"),
        [("eye: {", "eye: {namespace: /front, ")],
        [
            "eye.publishes.image/topic sssa: takes the topic `/image` from SSSA (`mind`); it is `/front/image` now"
        ],
    ),
    "a namespace that the name does not rest on": (NODES, [("eye: {", "eye: {namespace: /front, ")], []),
    "a remap of the topic": (
        NODES,
        [("eye: {", "eye: {remaps: {/eye/image: /eye/raw}, ")],
        ["eye.publishes.image/topic sssa: " + RENAMED.format("/eye/raw")],
    ),
    "a rule in the arguments": (
        NODES,
        [("eye: {", 'eye: {arguments: [--ros-args, -r, "/eye/image:=/eye/raw"], ')],
        ["eye.publishes.image/topic sssa: " + RENAMED.format("/eye/raw")],
    ),
    "a remap of a name that nobody wrote": (
        DERIVED,
        [("eye: {", "eye: {remaps: {/sensing/camera/image: /eye/raw}, ")],
        [
            (
                "eye/remaps./sensing/camera/image sssa: takes the topic `/sensing/camera/image` from SSSA (`mind`); "
                "it is `/eye/raw` now"
            )
        ],
    ),
    "a remap that fits nothing": (NODES, [("eye: {", "eye: {remaps: {/eye/imgae: /eye/raw}, ")], []),
    "a component after which the topic is called": (
        DERIVED,
        [("camera", "colour_camera")],
        [
            (
                "sensing.colour_camera sssa: takes the topic `/sensing/camera/image` from SSSA (`mind`); "
                "it is `/sensing/colour_camera/image` now"
            ),
            FOLLOWED.format("sensing.colour_camera"),
        ],
    ),
    "a component, where the topic has a name": (NODES, [("camera", "colour_camera")], [FOLLOWED.format("sensing.colour_camera")]),
    "a node": (NODES, [("  eye: {", "  left_eye: {")], []),
    "a node that writes what another one reads": (
        NODES,
        [(NODES[NODES.index("  eye:") : NODES.index("  mind:")], "")],
        [
            (
                "eye sssa: takes the topic `/eye/image` from SSSA (`mind`); "
                "nobody offers it under that name any more"
            )
        ],
    ),
    "a node that takes over": (
        NODES,
        [("  eye: {implements: camera, ", "  lens: {implements: camera, package: other, executable: one, ")],
        [],
    ),
    "a topic of no component": (
        NODES.replace(
            "eye: {", "eye: {internal: {publishes: {state: {topic: /eye/state, message: std_msgs/msg/String}}}, "
        ).replace(
            "mind: {", "mind: {internal: {subscribes: {state: {topic: /eye/state, message: std_msgs/msg/String}}}, "
        ),
        [("publishes: {state: {topic: /eye/state", "publishes: {state: {topic: /eye/status")],
        [
            (
                "eye.internal.publishes.state/topic sssa: takes the topic `/eye/state` from SSSA (`mind`); "
                "it is `/eye/status` now"
            )
        ],
    ),
    "a group after which the topic is called": (
        DERIVED,
        [("sensing", "seeing")],
        [
            "seeing sssa: takes the topic `/sensing/camera/image` from SSSA (`mind`); it is `/seeing/camera/image` now",
            FOLLOWED.format("seeing.camera").replace("seeing.camera sssa", "seeing sssa"),
        ],
    ),
    "a shared topic that the output of the reader keeps": (
        SHARED + "ros: {shared_topics: [/eye/all]}\n",
        [("image: {topic: /eye/all}", "image: {topic: /eye/rgb}")],
        [],
    ),
    "a topic that the output of the reader keeps, where another one left it": (
        SHARED,
        [("image: {topic: /eye/all}", "image: {topic: /eye/rgb}")],
        ["eye.publishes.image/topic sssa: takes the topic `/eye/all` from SSSA (`mind`); it is `/eye/rgb` now"],
    ),
    "a topic that a node without a port of it listens to": (
        SHARED.replace("mind: {", "mind: {internal: {subscribes: {all: {topic: /eye/rgb, message: sensor_msgs/msg/Image}}}, ").replace("image: {topic: /eye/all}", "image: {topic: /eye/rgb}"),
        [("image: {topic: /eye/rgb}", "image: {topic: /eye/rgba}")],
        ["eye.publishes.image/topic sssa: takes the topic `/eye/rgb` from SSSA (`mind`); it is `/eye/rgba` now"],
    ),
    "a topic that another partner publishes too": (
        NODES.replace("mind: {", "echo: {owner: tum, internal: {publishes: {image: {topic: /eye/image, message: sensor_msgs/msg/Image}}}}\n  mind: {"),
        [("{topic: /eye/image, qos", "{topic: /eye/rgb, qos")],
        ["eye.publishes.image/topic sssa: " + RENAMED.format("/eye/rgb")],
    ),
    "a topic whose reader becomes optional": (
        NODES,
        [("/eye/image", "/eye/rgb"), ("{image: camera.image}", "{image: {from: camera.image, optional: true}}")],
        ["eye.publishes.image/topic sssa: " + RENAMED.format("/eye/rgb")],
    ),
    "a topic whose reader is removed with it": (
        INTERNAL,
        [("publishes: {state: {topic: /s", "publishes: {state: {topic: /t"), (INTERNAL[INTERNAL.index("  mind:") :], "")],
        ["eye.internal.publishes.state/topic sssa: takes the topic `/s` from SSSA (`mind`); it is `/t` now"],
    ),
    "a topic that only a new, planned node still has": (
        NODES,
        [("topic: /eye/image", "topic: /eye/rgb"), ("  mind:", "  ghost: {implements: camera, status: planned, publishes: {image: /eye/image}}\n  mind:")],
        ["eye.publishes.image/topic sssa: " + RENAMED.format("/eye/rgb")],
    ),
    "a topic that a new node keeps": (
        NODES,
        [("topic: /eye/image", "topic: /eye/rgb"), ("  mind:", "  lens: {implements: camera, publishes: {image: /eye/image}}\n  mind:")],
        [],
    ),
    "a topic that a new, planned node takes over": (
        NODES,
        [("publishes: {image: {topic: /eye/image, qos: {reliability: reliable, deadline: 50 ms}}}}", "status: existing, publishes: {depth: }}\n  lens: {implements: camera, status: planned, publishes: {image: {topic: /eye/image, qos: {reliability: reliable, deadline: 50 ms}}}}")],
        ["eye.publishes.image sssa: takes the topic `/eye/image` from SSSA (`mind`); nobody offers it under that name any more"],
    ),
    "a topic of no component with another message": (
        INTERNAL,
        [("publishes: {state: {topic: /s, message: std_msgs/msg/String", "publishes: {state: {topic: /s, message: std_msgs/msg/Bool")],
        [
            (
                "eye.internal.publishes.state/message sssa: sends `std_msgs/msg/Bool` instead of `std_msgs/msg/String` on `/s`, to which "
                "`mind` of SSSA subscribes"
            )
        ],
    ),
    "a topic whose reader is called otherwise": (
        INTERNAL,
        [("publishes: {state: {topic: /s", "publishes: {state: {topic: /t"), ("mind:", "brain:")],
        ["eye.internal.publishes.state/topic sssa: takes the topic `/s` from SSSA (`brain`); it is `/t` now"],
    ),
    "a topic of no component beside a new one of another node": (
        INTERNAL,
        [("publishes: {state: {topic: /s", "publishes: {state: {topic: /t"), ("mind: {", "lamp: {internal: {publishes: {on: {topic: /on, message: std_msgs/msg/Bool}}}}\n  mind: {")],
        ["eye.internal.publishes.state/topic sssa: takes the topic `/s` from SSSA (`mind`); it is `/t` now"],
    ),
    "a topic that another node publishes under its own name": (
        NODES,
        [("  mind:", "  lens: {implements: camera, publishes: {image: {topic: /lens/image}}}\n  mind:"), ("publishes: {image: {topic: /eye/image, qos: {reliability: reliable, deadline: 50 ms}}}", "publishes: {depth: {topic: /eye/depth}}")],
        ["eye.publishes.image sssa: takes the topic `/eye/image` from SSSA (`mind`); it is `/lens/image` now"],
    ),
    "a service": (
        BASE.replace("Colour image", "std_srvs/srv/Trigger")
        + "nodes:\n  eye: {implements: camera, serves: {image: {topic: /eye/trigger}}}\n  mind: {implements: tracker}\n".replace(
            "{topic: /eye/trigger}", "/eye/trigger"
        ),
        [("/eye/trigger", "/eye/go")],
        [
            "eye.serves.image/topic sssa: takes the service `/eye/trigger` from SSSA (`mind`); it is `/eye/go` now"
        ],
    ),
    "quality that is not enough": (NODES, [FEWER], [f"eye.publishes.image/qos sssa: {UNHEARD}"]),
    "quality that both lower": (
        NODES,
        [("reliability: reliable", "reliability: best_effort")],
        [f"eye.publishes.image/qos sssa: {UNHEARD}"],
    ),
    "quality that only the reader lowers": (
        NODES,
        [("{qos: {reliability: reliable}}", "{qos: {reliability: best_effort}}")],
        [],
    ),
    "quality for a reader that is taken away with it": (
        NODES,
        [FEWER, ("  mind: {implements: tracker, subscribes: {image: {qos: {reliability: reliable}}}}\n", "")],
        [f"eye.publishes.image/qos sssa: {UNHEARD}"],
    ),
    "quality for a reader that becomes optional": (
        NODES,
        [FEWER, ("{image: camera.image}", "{image: {from: camera.image, optional: true}}")],
        [f"eye.publishes.image/qos sssa: {UNHEARD}"],
    ),
    "quality that is still enough": (NODES, [("deadline: 50 ms", "deadline: 80 ms")], []),
    "a deadline that is not": (
        NODES.replace("subscribes: {image: {qos: {", "subscribes: {image: {qos: {deadline: 60 ms, "),
        [("deadline: 50 ms", "deadline: 80 ms")],
        [
            (
                "eye.publishes.image/qos sssa: offers one every 80 ms on `/eye/image`, where `mind` of SSSA asks for a message every 60 ms: "
                "nothing arrives any more"
            )
        ],
    ),
    "a reader who asks for more": (
        NODES,
        [("{qos: {reliability: reliable}}", "{qos: {durability: transient_local}}")],
        [],
    ),
    "quality that was not enough before": (NODES.replace(*FEWER), [("deadline: 50 ms", "deadline: 80 ms")], []),
    "quality for oneself": (NODES.replace("owner: sssa", "owner: certh"), [FEWER], []),
    "quality that a reader without a node asks for": (NODES[: NODES.index("  mind:")], [FEWER], []),
    "quality that a writer without a node offers": (
        NODES[: NODES.index("  eye:")] + NODES[NODES.index("  mind:") :].replace("{reliability: reliable", "{durability: volatile"),
        [("durability: volatile", "durability: transient_local")],
        [],
    ),
    "quality for an optional input": (
        NODES.replace("{image: camera.image}", "{image: {from: camera.image, optional: true}}"),
        [FEWER],
        [],
    ),
    "quality for a node that another partner owns": (
        NODES.replace("mind: {", "mind: {owner: tum, "),
        [FEWER],
        [f"eye.publishes.image/qos tum: {UNHEARD.replace('SSSA', 'TUM')}"],
    ),
    "quality for nobody": (NODES.replace("owner: sssa", "title: T"), [FEWER], []),
    "quality of a topic that is called otherwise": (
        NODES,
        [FEWER, ("/eye/image", "/eye/rgb")],
        [
            "eye.publishes.image/qos sssa: " + UNHEARD.replace("/eye/image", "/eye/rgb"),
            "eye.publishes.image/topic sssa: " + RENAMED.format("/eye/rgb"),
        ],
    ),
    "quality of two kinds": (
        NODES.replace("{qos: {reliability: reliable}}", "{qos: {reliability: reliable, deadline: 60 ms}}"),
        [("reliability: reliable, deadline: 50 ms", "reliability: best_effort, deadline: 80 ms")],
        ["eye.publishes.image/qos sssa: offers best effort only and one every 80 ms on `/eye/image`, where `mind` of SSSA asks for reliable delivery and a message every 60 ms: nothing arrives any more"],
    ),
    "quality that is not enough while the reader asks for more": (
        NODES.replace("{qos: {reliability: reliable}}", "{qos: {reliability: reliable, deadline: 60 ms}}"),
        [FEWER, ("deadline: 60 ms", "deadline: 40 ms")],
        [f"eye.publishes.image/qos sssa: {UNHEARD}"],
    ),
    "quality of a component that is called otherwise": (
        NODES,
        [FEWER, ("camera", "colour_camera")],
        [f"eye.publishes.image/qos sssa: {UNHEARD}", FOLLOWED.format("sensing.colour_camera")],
    ),
    "quality for a component that is called otherwise": (
        NODES,
        [FEWER, ("tracker", "follower")],
        [f"eye.publishes.image/qos sssa: {UNHEARD}"],
    ),
    "quality of a topic of no component": (
        INTERNAL,
        [("{topic: /s, message: std_msgs/msg/String, qos: {reliability: reliable}}}}}\n  mind", "{topic: /s, message: std_msgs/msg/String, qos: {reliability: best_effort}}}}}\n  mind")],
        [f"eye.internal.publishes.state/qos sssa: {UNHEARD.replace('/eye/image', '/s')}"],
    ),
    "quality in ROS 1": (NODES + "ros: {distro: noetic}\n", [FEWER], []),
}  # fmt: skip


@pytest.mark.parametrize(("project", "edits", "said"), try_some(NAMES.values(), 27), ids=NAMES.keys())
def test_names_and_quality(compared: Compared, project: str, edits: list[tuple[str, str]], said: list[str]) -> None:
    assert broken(compared, project, edits) == said


MESSAGES = (
    BASE.replace("Colour image", "x_msgs/msg/Image").replace("Tracks", "x_msgs/msg/Tracks")
    + """\
ros:
  distro: jazzy
  definitions:
    x_msgs/msg/Tracks: "uint32[] ids"
    x_msgs/msg/Pixel: |
      uint8 red
      uint8 blue
    x_msgs/msg/Image: |
      Pixel[] pixels
      # a comment
"""
)
NEW = "what was built before cannot talk to what is built after"
DEFINITIONS = {
    "a field less": (
        MESSAGES,
        [("      uint8 blue\n", "")],
        [f"x_msgs/msg/Pixel/fields sssa: removes `blue` in `x_msgs/msg/Pixel`, which SSSA uses; {NEW}"],
    ),
    "a field of another type": (
        MESSAGES,
        [("Pixel[] pixels", "Pixel[<=9] pixels")],
        [f"x_msgs/msg/Image/fields sssa: changes the type of `pixels` in `x_msgs/msg/Image`, which SSSA uses; {NEW}"],
    ),
    "a field more": (
        MESSAGES,
        [("uint8 blue", "uint8 blue\n      uint8 green")],
        [
            (
                "x_msgs/msg/Pixel/fields sssa: adds `green` in `x_msgs/msg/Pixel`, which SSSA uses; even a field more makes another message "
                f"to ROS: {NEW}"
            )
        ],
    ),
    "fields in another order": (
        MESSAGES,
        [("      uint8 red\n      uint8 blue\n", "      uint8 blue\n      uint8 red\n")],
        [f"x_msgs/msg/Pixel/fields sssa: puts fields in another order in `x_msgs/msg/Pixel`, which SSSA uses; {NEW}"],
    ),
    "another comment": (
        MESSAGES,
        [("# a comment", "# another comment")],
        [
            "x_msgs/msg/Image/comment sssa: says of `x_msgs/msg/Image` `another comment` instead of `a comment`; SSSA uses it"
        ],
    ),
    "the same comment in other letters": (MESSAGES, [("# a comment", "# A comment.")], []),
    "a message that nobody else reads": (MESSAGES, [("uint32[] ids", "uint32[] numbers")], []),
}


@pytest.mark.parametrize(("project", "edits", "said"), DEFINITIONS.values(), ids=DEFINITIONS.keys())
def test_definitions(compared: Compared, project: str, edits: list[tuple[str, str]], said: list[str]) -> None:
    assert broken(compared, project, edits) == said


def test_a_message_that_two_write_is_nobodys(compared: Compared) -> None:
    both = MESSAGES.replace("tracks: x_msgs/msg/Tracks", "tracks: x_msgs/msg/Image")
    found = broken(compared, both, [("      uint8 blue\n", "")])
    assert [line.split(":")[0] for line in found] == ["x_msgs/msg/Pixel/fields certh", "x_msgs/msg/Pixel/fields sssa"]
