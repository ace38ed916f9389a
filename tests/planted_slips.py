"""Slips planted into a sound project, what its check says of them, and what comes of doing literally what that says."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.compare_versions import compare_versions
from archgen.diagnostics.suggested_fixes import apply_edits, suggest_fix
from archgen.model.architecture import Architecture
from archgen.pipeline import CheckedProject, judge_project
from archgen.project.project_loading import load_from_files
from archgen.syntax.project_files import OverlaidFiles

SEED = """\
archgen: 1
project:
  id: picker
  title: Orchard picker
ros:
  distro: jazzy
partners:
  wur:
    title: Wageningen University
    reviewers: "@wur/agro"
  tud:
    title: Delft University
requirements:
  R-1: Stops before people
  R-2:
    title: Picks a crate in an hour
    priority: must
groups:
  perception:
    title: Perception
    owner: wur
    components:
      stereo_camera:
        functionality: Sees the trees.
        role: source
        status: existing
        requirements: [R-1]
        inputs:
          light:
            external: Daylight
            medium: physical
        outputs:
          image: Colour image
          depth:
            type: Depth image
      person_detector:
        functionality: "Finds people: in each image."
        requirements:
          - R-1
        inputs:
          image: perception.stereo_camera.image
          depth:
            from: perception.stereo_camera.depth
            freshness: 300 ms
        outputs:
          persons: Persons
        timing:
          rate: 15 Hz
          wcet: 20 ms
  driving:
    title: Driving
    owner: [tud]
    components:
      safety_stop:
        functionality: Stops the wheels.
        requirements: [R-1, R-2]
        inputs:
          persons: perception.person_detector.persons
        outputs:
          velocity: Velocity
      wheels:
        functionality: Turns the wheels.
        role: sink
        inputs:
          velocity: driving.safety_stop.velocity
types:
  Colour image: sensor_msgs/msg/Image
  Depth image:
    message: sensor_msgs/msg/PointCloud2
    size: 2 MB
  Persons: vision_msgs/msg/Detection3DArray
  Velocity:
    message: geometry_msgs/msg/Twist
nodes:
  camera_driver:
    implements: perception.stereo_camera
    package: camera_ros
    kind: driver
    status: existing
    host: onboard_pc
    publishes:
      image: /camera/image
    timing:
      rate: 15 Hz
      wcet: 2 ms
  detector:
    implements: perception.person_detector
    package: detector
    status: planned
    host: onboard_pc
    parameters:
      threshold: 0.5
  stopper:
    implements: driving.safety_stop
    package: stopper
    status: planned
    host: onboard_pc
    timing:
      wcet: 1 ms
      trigger: [persons]
hosts:
  onboard_pc:
    title: Onboard computer
    cores: 8
  base_pc:
    title: Base computer
    cores: 2
links:
  ethernet:
    connects: [onboard_pc, base_pc]
    bandwidth: 1 Gbit/s
chains:
  person_stop:
    title: From a person to the stop
    through: [perception.stereo_camera, perception.person_detector, driving.safety_stop]
    deadline: 400 ms
    requirements: [R-1]
"""
"""Every common kind of element, key, reference and value, in the block form that people write."""

FILE = "archgen.yaml"


@dataclass(frozen=True)
class Slip:
    """A slip by its kind, and the project's text with it."""

    kind: str
    name: str
    text: str
    meant: str = ""
    """The text that was meant, where the slip adds something to the seed."""


def judge_text(text: str) -> CheckedProject:
    """Check a project of one file."""
    return judge_project(load_from_files(OverlaidFiles(Path(), {FILE: text.encode()}), FILE))


@dataclass(frozen=True)
class Outcome:
    """What came of a slip: whether it was found, what the first help about it says, and what following that made."""

    slip: Slip
    is_found: bool
    help: str
    verdict: str
    """`mended` (the model is as it was), `same` (no error, same meaning but not all is back), `left` (nothing to apply),
    `fails` (the finding stays, or another error comes), `misleads` (no error any more, and the model says something else)."""


def follow_help(slip: Slip, seed: CheckedProject) -> Outcome:
    """Check a text with a slip, do what the help of its findings says, one after another, and look at the model."""
    text, first_help, is_found = slip.text, "", False
    meant = judge_text(slip.meant) if slip.meant else seed
    known = {(finding.rule, finding.message) for finding in (*seed.findings, *meant.findings)}
    for _ in range(3):
        checked = judge_text(text)
        news = [f for f in checked.findings if (f.rule, f.message) not in known]
        news.sort(key=lambda finding: finding.effective_severity, reverse=True)
        is_found = is_found or bool(news)
        if not news:
            break
        first_help = first_help or next((str(f.help) for f in news[:1]), "")
        fix = next((fix for f in news if (fix := suggest_fix(f, checked.sources))), None)
        if fix is None:
            verdict = "left" if text == slip.text else "fails"
            return Outcome(slip, is_found, first_help, verdict)
        text = apply_edits(text, fix.edits)
    checked = judge_text(text)
    if not is_found:
        return Outcome(slip, is_found=False, help="", verdict="left")
    if is_same_model(checked.architecture, meant.architecture):
        return Outcome(slip, is_found, first_help, "mended")
    return Outcome(slip, is_found, first_help, "fails" if checked.has_errors else "misleads")


def is_same_model(one: Architecture, other: Architecture) -> bool:
    """Whether two models say the same; places do not count, nor how much of a path is written."""
    return one == other or not compare_versions(ArchitectureVersion(other), ArchitectureVersion(one)).changes


def list_slips() -> Iterator[Slip]:
    """Yield slips of all kinds, each planted into the seed at one place."""
    yield from _misspell_keys()
    yield from _misspell_words()
    yield from _misindent()
    yield from _write_otherwise()


def _plant(kind: str, old: str, new: str, which: int = 0) -> Iterator[Slip]:
    """Replace one occurrence of a text."""
    places = [match.start() for match in re.finditer(re.escape(old), SEED)]
    assert len(places) > which, old
    start = places[which]
    yield Slip(kind, f"{old!r} -> {new!r}", SEED[:start] + new + SEED[start + len(old) :])


_KEYS = [
    "project",
    "title",
    "partners",
    "reviewers",
    "requirements",
    "priority",
    "groups",
    "owner",
    "components",
    "functionality",
    "role",
    "status",
    "inputs",
    "external",
    "medium",
    "outputs",
    "type",
    "from",
    "freshness",
    "timing",
    "rate",
    "wcet",
    "types",
    "message",
    "size",
    "nodes",
    "implements",
    "package",
    "kind",
    "host",
    "publishes",
    "parameters",
    "hosts",
    "cores",
    "links",
    "connects",
    "bandwidth",
    "chains",
    "through",
    "deadline",
]


def _misspell_keys() -> Iterator[Slip]:
    for key in _KEYS:
        middle = len(key) // 2
        spellings = {
            "swapped": key[: middle - 1] + key[middle] + key[middle - 1] + key[middle + 1 :],
            "dropped": key[:middle] + key[middle + 1 :],
            "capital": key.capitalize(),
            "plural": key[:-1] if key.endswith("s") else f"{key}s",
        }
        for kind, spelling in spellings.items():
            if (spelling not in _KEYS and spelling not in {"group", "titles"}) or spelling not in _KEYS:
                yield from _plant(f"key {kind}", f"{key}:", f"{spelling}:")


_WORDS = {
    "partner": ("owner: wur", ("owner: wru", "owner: WUR", "owner: Wageningen University", "owner: wurr")),
    "host": ("host: onboard_pc", ("host: onbord_pc", "host: Onboard computer", "host: onboard-pc", "host: onboardpc")),
    "output": (
        "image: perception.stereo_camera.image",
        (
            "image: perception.stereo_camera.imgae",
            "image: perception.stereo_camra.image",
            "image: perception.stereo-camera.image",
            "image: perception.Stereo_Camera.image",
            "image: preception.stereo_camera.image",
            "image: perception/stereo_camera/image",
            "image: perception.stereo_camera.images",
        ),
    ),
    "source": (
        "from: perception.stereo_camera.depth",
        ("from: perception.stereo_camera.dept", "from: stereo_camera.detph"),
    ),
    "component": (
        "implements: driving.safety_stop",
        (
            "implements: driving.safty_stop",
            "implements: safety_stopp",
            "implements: driving.safety-stop",
            "implements: driving.SafetyStop",
        ),
    ),
    "requirement": (
        "requirements: [R-1, R-2]",
        ("requirements: [R-1, R2]", "requirements: [R-1, r-2]", "requirements: [R-1, R_2]"),
    ),
    "link end": ("[onboard_pc, base_pc]", ("[onboard_pc, base_cp]", "[onboard_pc, Base_PC]")),
    "chain step": (
        "perception.person_detector, driving.safety_stop]",
        ("perception.persn_detector, driving.safety_stop]", "perception.person_detector, driving.safety_stpo]"),
    ),
    "trigger": ("trigger: [persons]", ("trigger: [person]", "trigger: [Persons]")),
    "role": ("role: source", ("role: sorce", "role: Source", "role: SOURCE")),
    "status": ("status: existing", ("status: exsting", "status: Existing")),
    "node status": ("status: planned", ("status: planed", "status: Planned")),
    "kind": ("kind: driver", ("kind: drivr", "kind: Driver")),
    "medium": ("medium: physical", ("medium: phyiscal",)),
    "distro": ("distro: jazzy", ("distro: jazy", "distro: Jazzy")),
    "type of ours": (
        "type: Depth image",
        ("type: Depth imag", "type: depth image", "type: Depth Image", "type: Depthimage"),
    ),
    "message": (
        "Colour image: sensor_msgs/msg/Image",
        (
            "Colour image: sensor_msgs.msg.Image",
            "Colour image: sensor_msgs::msg::Image",
            "Colour image: sensor_msgs/msg/image",
            "Colour image: sensor_msg/msg/Image",
            "Colour image: sensor_msgs/msgs/Image",
            "Colour image: sensor_msgs/msg/Imgae",
            "Colour image: std_msgs/msg/Image",
        ),
    ),
    "message elsewhere": (
        "message: geometry_msgs/msg/Twist",
        ("message: nav_msgs/msg/Twist", "message: sensor_msgs/msg/Twist", "message: geometry_msgs/msg/Twsit"),
    ),
    "vision": (
        "Persons: vision_msgs/msg/Detection3DArray",
        ("Persons: vision_msgs/msg/Detections3DArray", "Persons: visoin_msgs/msg/Detection3DArray"),
    ),
    "duration": (
        "wcet: 20 ms",
        (
            "wcet: 20 MS",
            "wcet: 20 msec",
            "wcet: 20 milliseconds",
            "wcet: 20,0 ms",
            "wcet: 20",
            "wcet: 0.020",
            "wcet: -20 ms",
            "wcet: 20 mms",
            "wcet: 20 Ms",
            "wcet: '20 ms '",
        ),
    ),
    "rate": ("rate: 15 Hz", ("rate: 15 hz", "rate: 15 HZ", "rate: 15", "rate: 15 fps", "rate: 15 herz")),
    "size": ("size: 2 MB", ("size: 2 mb", "size: 2 Mb", "size: 2 megabytes", "size: 2")),
    "bandwidth": (
        "bandwidth: 1 Gbit/s",
        ("bandwidth: 1 Gbps", "bandwidth: 1 gbit/s", "bandwidth: 1 GBit/s", "bandwidth: 1 Gb/s", "bandwidth: 1"),
    ),
    "deadline": ("deadline: 400 ms", ("deadline: 400 msecs", "deadline: 400", "deadline: 400 Hz")),
    "cores": ("cores: 8", ("cores: eight", "cores: '8'", "cores: -8", "cores: 8 cores")),
    "id": (
        "  base_pc:",
        ("  base-pc:", "  Base_pc:", "  basePc:", "  base pc:"),
    ),
    "id of a component": ("      wheels:", ("      Wheels:",)),
    "topic": ("image: /camera/image", ("image: /camera/-image", "image: /camera//image")),
}


def _misspell_words() -> Iterator[Slip]:
    for kind, (old, spellings) in _WORDS.items():
        for new in spellings:
            yield from _plant(kind, old, new)


def _block_at(key_line: str) -> tuple[int, int]:
    lines = SEED.splitlines()
    first = lines.index(key_line)
    indent = len(key_line) - len(key_line.lstrip())
    end = first + 1
    while end < len(lines) and len(lines[end]) - len(lines[end].lstrip()) > indent:
        end += 1
    return first, end


_BLOCKS = (
    "      person_detector:", "        timing:", "        outputs:", "  driving:", "      wheels:", "  detector:",
    "  base_pc:", "    publishes:", "        inputs:", "    components:", "          depth:", "  tud:",
)  # fmt: skip


def _misindent() -> Iterator[Slip]:
    lines = SEED.splitlines()
    for key_line in _BLOCKS:
        first, end = _block_at(key_line)
        for shift in (-2, 2, -1, 1):
            if len(key_line) - len(key_line.lstrip()) + shift >= 0:
                moved = [" " * shift + line if shift > 0 else line[-shift:] for line in lines[first:end]]
                text = "\n".join([*lines[:first], *moved, *lines[end:]]) + "\n"
                yield Slip(f"indentation {shift:+}", key_line.strip(), text)
        # The key alone.
        for shift in (-2, 2):
            if len(key_line) - len(key_line.lstrip()) + shift >= 0:
                key = " " * shift + key_line if shift > 0 else key_line[-shift:]
                text = "\n".join([*lines[:first], key, *lines[first + 1 :]]) + "\n"
                yield Slip(f"indentation of the key {shift:+}", key_line.strip(), text)
    for number in (4, 23, 35, 75):
        text = "\n".join([*lines[:number], "\t" + lines[number].lstrip(), *lines[number + 1 :]]) + "\n"
        yield Slip("tab", lines[number].strip(), text)


def _write_otherwise() -> Iterator[Slip]:
    """Yield slips of YAML and of form."""
    pairs = {
        "no quotes": [('"@wur/agro"', "@wur/agro"), ('"Finds people: in each image."', "Finds people: in each image.")],
        "odd quotes": [('"@wur/agro"', "“@wur/agro”"), ('"Finds people: in each image."', "“Finds people: in each image.”")],
        "quote not closed": [('"@wur/agro"', '"@wur/agro'), ('image."', "image.")],
        "odd blank": [("owner: wur", "owner:\u00a0wur"), ("  host: onboard_pc", "\u00a0 host: onboard_pc"), ("rate: 15 Hz", "rate: 15\u00a0Hz")],
        "no blank": [("owner: wur", "owner:wur"), ("rate: 15 Hz", "rate:15 Hz"), ("host: onboard_pc", "host:onboard_pc")],
        "no colon": [("        timing:\n", "        timing\n"), ("owner: wur", "owner wur"), ("  base_pc:\n", "  base_pc\n")],
        "equals": [("owner: wur", "owner = wur"), ("rate: 15 Hz", "rate=15 Hz")],
        "list of ports": [("          persons: Persons\n", "          - persons: Persons\n")],
        "list of elements": [("  base_pc:\n    title:", "  - id: base_pc\n    title:"), ("  wur:\n    title", "  - id: wur\n    title")],
        "scalar for list": [("connects: [onboard_pc, base_pc]", "connects: onboard_pc, base_pc"), ("[R-1, R-2]", "R-1, R-2"), ("[R-1, R-2]", "R-1 R-2")],
        "list for scalar": [("host: onboard_pc", "host: [onboard_pc]"), ("role: source", "role: [source]"), ("rate: 15 Hz", "rate: [15 Hz]")],
        "bracket": [("[R-1, R-2]", "[R-1, R-2"), ("[R-1, R-2]", "R-1, R-2]"), ("[R-1, R-2]", "{R-1, R-2}")],
        "dash": [("          - R-1\n", "          -R-1\n"), ("R-1: Stops", "R\u20131: Stops")],
        "section": [("nodes:\n", "node:\n"), ("hosts:\n", "host:\n"), ("types:\n", "messages:\n"), ("chains:\n", "chain:\n")],
        "other key": [("rate: 15 Hz", "frequency: 15 Hz"), ("wcet: 20 ms", "execution_time: 20 ms"), ("owner: wur", "responsible: wur") ],
        "twice": [("    owner: wur\n", "    owner: wur\n    owner: wur\n"), ("  base_pc:\n", "  onboard_pc:\n")],
        "exchanged": [
            (
                "        inputs:\n          persons: perception.person_detector.persons\n        outputs:\n          velocity: Velocity",
                "        outputs:\n          persons: perception.person_detector.persons\n        inputs:\n          velocity: Velocity",
            )
        ],
        "conflict": [("    owner: wur\n", "<<<<<<< HEAD\n    owner: wur\n=======\n    owner: tud\n>>>>>>> other\n")],
        "comment": [("title: Delft University", "title: Delft University #3"), ("title: Perception", "title: #1 Perception")],
        "escape": [('"@wur/agro"', '"\\@wur/agro"')],
        "reference to an input": [("velocity: driving.safety_stop.velocity", "velocity: driving.safety_stop.persons")],
        "component for an output": [("implements: driving.safety_stop", "implements: driving.safety_stop.velocity")],
        "group for a component": [("implements: driving.safety_stop", "implements: driving")],
    }  # fmt: skip
    for kind, slips in pairs.items():
        for old, new in slips:
            yield from _plant(kind, old, new)
    for place, key, meant in (
        ("        role: sink\n", "        rate: 15 Hz\n", "        timing: {rate: 15 Hz}\n"),
        ("        role: sink\n", "        wcet: 9 ms  # measured\n", "        timing: {wcet: 9 ms}  # measured\n"),
        ("        role: sink\n", "        package: motors\n", "        node: {package: motors}\n"),
        ("        role: sink\n", "        host: onboard_pc\n", "        node: {host: onboard_pc}\n"),
    ):
        start = SEED.index(place)
        texts = (SEED[:start] + added + SEED[start:] for added in (key, meant))
        yield Slip("misplaced key", key.strip(), *texts)
