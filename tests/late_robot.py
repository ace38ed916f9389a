"""A small robot of four partners, for what rests on each of them."""

from __future__ import annotations

from pathlib import Path

from archgen.pipeline import CheckedProject, check_project

ROBOT = """\
archgen: 1
ros: {distro: jazzy}
partners: {north: {title: North}, south: {title: South}, west: {title: West}, idle: {title: Idle}}
types: {Picture: sensor_msgs/msg/Image, Word: std_msgs/msg/String, Answer: std_srvs/srv/Trigger}
requirements: {R-1: {title: It sees}, R-2: {title: It speaks}, R-3: {title: It waits}}
use_cases:
  UC-1:
    title: A talk
    actors: {guest: Guest}
    steps:
      - {from: guest, to: eye}
      - {from: eye, to: brain}
      - {from: brain, to: mouth}
      - {from: mouth, to: guest}
  UC-2: {title: A rest, actors: {guest: Guest}, steps: [{from: guest, to: bed}]}
groups:
  g:
    components:
      eye: {title: Eye, owner: north, requirements: [R-1], inputs: {world: {external: light}}, outputs: {picture: Picture, odd: Sketch}}
      brain:
        title: Brain
        owner: south
        requirements: [R-1, R-2]
        inputs: {see: eye.picture, feel: {from: eye.odd, optional: true}}
        outputs: {word: Word, ask: Answer}
      mouth: {title: Mouth, owner: north, requirements: [R-2], inputs: {say: brain.word}, outputs: {sound: {external: air}}}
      log: {title: Log, owner: west, inputs: {see: {from: eye.picture, optional: true}, ask: brain.ask}}
      bed: {title: Bed, inputs: {weight: {external: guest}}, requirements: [R-3], outputs: {load: Word}}
      scale: {title: Scale, inputs: {load: bed.load}, requirements: [R-3]}
nodes:
  eye: {implements: eye, timing: {period: 100 ms, wcet: 5 ms}}
  brain: {implements: brain, timing: {behaviour: event, trigger: [see], wcet: 10 ms}}
  mouth: {implements: mouth, timing: {behaviour: event, trigger: [say], wcet: 1 ms}}
chains:
  talk: {title: It answers, through: [eye, brain, mouth], deadline: 400 ms, requirements: [R-2]}
  look: {title: It looks, through: [eye, brain]}
rules: {open-chain: off}
"""


def check(folder: Path, text: str = ROBOT, error_rules: tuple[str, ...] = ()) -> CheckedProject:
    """Check the robot, or another one, as a project of its own: it has errors of these rules alone."""
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    checked = check_project(folder)
    assert tuple(each.rule for each in checked.findings if each.severity == "error") == error_rules
    return checked
