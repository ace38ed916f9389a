"""A site that is written again into its folder after a change has the bytes of one that is written for the first time."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.products import project_outputs
from archgen.products.output_options import OutputOptions
from tests.running import contents

PROJECT = """\
archgen: 1
project: {id: rover, title: Rover}
ros: {distro: jazzy}
partners: {acme: {title: Acme}, beta: {title: Beta}}
requirements: {R-1: {title: It stops}}
report: {chapters: [intro.md, overview, groups, deployment, timing, chains, types, requirements, open_points]}
hosts: {pc: {title: Computer, cores: 2}}
groups:
  sense:
    title: Sensing
    owner: acme
    components:
      eye:
        title: Eye
        functionality: Sees what is there.
        outputs: {view: Picture, depth: Depth image}
      ear: {title: Ear, outputs: {sound: Sound}}
  act:
    title: Acting
    owner: beta
    components:
      brain:
        title: Brain
        requirements: [R-1]
        inputs: {view: sense.eye.view, sound: sense.ear.sound}
        outputs: {order: Order}
      leg: {title: Leg, inputs: {order: brain.order}}
nodes:
  eye_node:
    implements: sense.eye
    host: pc
    timing: {behaviour: periodic, rate: 10 Hz, wcet: 5 ms}
  brain_node: {implements: act.brain, host: pc, timing: {behaviour: periodic, rate: 5 Hz, wcet: 9 ms}}
chains:
  seen: {title: From eye to leg, through: [sense.eye, act.brain], deadline: 900 ms}
"""

CHANGES = {
    "the title of a group": ("title: Sensing", "title: All senses of the robot together"),
    "the title of a component": ("title: Eye", "title: Camera of the robot's head"),
    "a title of the same width": ("title: Leg", "title: Gel"),
    "the title of the project": ("title: Rover", "title: Wanderer"),
    "a description": ("Sees what is there.", "Sees <nothing> & says so."),
    "an owner": ("owner: beta", "owner: acme"),
    "the title of a partner": ("title: Beta", "title: Better"),
    "a period": ("rate: 10 Hz", "rate: 12.5 Hz"),
    "a deadline that is missed": ("deadline: 900 ms", "deadline: 9 ms"),
    "a new component": ("      ear: {", "      nose: {title: Nose, outputs: {smell: Smell}}\n      ear: {"),
    "a removed component": ("      nose: {title: Nose, outputs: {smell: Smell}}\n", ""),
    "a renamed type": ("view: Picture,", "view: Colour image,"),
    "a finding that appears": (", deadline: 9 ms", ""),
    "an input less": ("sound: sense.ear.sound", ""),
    "the title of a requirement": ("It stops", "It stops at once"),
    "a status": (
        "host: pc, timing: {behaviour: periodic, rate: 5 Hz",
        "host: pc, status: adapted, timing: {rate: 5 Hz",
    ),
}


@pytest.mark.slow
def test_after_each_change_a_site_is_as_if_written_for_the_first_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, options = tmp_path / "rover", OutputOptions(revision="test")
    folder.mkdir()
    (folder / "intro.md").write_text("# Before\n\nWhat it is.\n")
    text = PROJECT

    def write_site(name: str, cache: str) -> dict[str, bytes]:
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / cache))
        project_outputs.write_site(check_project(folder), options, tmp_path / name)
        return contents(tmp_path / name)

    def compare_with_fresh(change: str, number: int) -> None:
        again, fresh = write_site("site", "cache"), write_site(f"fresh-{number}", f"cache-{number}")
        assert sorted(again) == sorted(fresh), change
        assert [name for name, data in again.items() if data != fresh[name]] == [], change

    (folder / "archgen.yaml").write_text(text)
    before = first = write_site("site", "cache")
    for number, (change, (old, new)) in enumerate(CHANGES.items()):
        assert text.count(old) == 1, change
        text = text.replace(old, new)
        (folder / "archgen.yaml").write_text(text)
        compare_with_fresh(change, number)
        after = contents(tmp_path / "site")
        assert after != before, f"{change} is seen nowhere"
        before = after
    (folder / "intro.md").write_text("# Before\n\nWhat it *was*.\n")
    compare_with_fresh("the text of a chapter", len(CHANGES))
    assert contents(tmp_path / "site") != before
    (folder / "archgen.yaml").write_text(PROJECT)
    (folder / "intro.md").write_text("# Before\n\nWhat it is.\n")
    assert write_site("site", "cache") == first, "all changes undone"
