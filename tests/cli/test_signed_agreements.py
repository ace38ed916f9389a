"""`archgen interfaces` and what was signed: tags that record it, versions, dates, and what departs from it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.property_sizes import try_some
from tests.repositories import commit, git, repository

ROBOT = """\
archgen: 1
project: {id: mini, title: Mini Robot}
ros: {distro: jazzy}
requirements: {R-1: {title: Stops in time}}
partners: {a: Alpha, b: Beta, c: Gamma}
groups:
  sense:
    owner: a
    components:
      lidar: {requirements: [R-1], outputs: {scan: Scan}}
      eye: {inputs: {scan: lidar.scan}, outputs: {stop: Stop}}
      bell: {outputs: {alarm: Stop}}
  drive: {owner: b, components: {base: {inputs: {stop: eye.stop, alarm: bell.alarm, scan: lidar.scan}}}}
types: {Scan: {message: sensor_msgs/msg/LaserScan, size: 1 kB}, Stop: {message: std_msgs/msg/Header, size: 40 B}}
nodes:
  lidar_driver: {implements: lidar, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}, publishes: {scan: {topic: /scan, qos: sensor_data}}}
  eye_node: {implements: eye, host: pc, timing: {wcet: 20 ms}, publishes: {stop: {topic: /stop, qos: {deadline: 200 ms}}}}
  bell_node: {implements: bell, host: pc, timing: {rate: 1 Hz, wcet: 1 ms, outputs: {alarm: {conditional: true, max_gap: 9 s}}}}
  base_node: {implements: base, host: pc, timing: {wcet: 1 ms}, subscribes: {scan: {qos: sensor_data}}}
hosts: {pc: {cores: 4}}
chains: {halt: {title: Halt, through: [lidar, eye, base], deadline: 300 ms}}
"""


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("GIT_COMMITTER_DATE", "2026-03-01T23:30:00 -0500")
    root = repository(tmp_path / "top", {"robot/archgen.yaml": ROBOT})
    return root / "robot"


def agree(run: Run, folder: Path, *words: str) -> str:
    ran = run("interfaces", folder, "--between", "a", "b", *words)
    assert ran.status == 0, ran.err
    return ran.out


def versions(markdown: str) -> list[str]:
    return [re.sub(r"\b[0-9a-f]{6,7}\b", "V", line) for line in re.findall(r"\*\*Version:\*\* (.*)", markdown)]


def change(folder: Path, old: str, new: str) -> None:
    text = (folder / "archgen.yaml").read_text(encoding="utf-8")
    assert old in text
    (folder / "archgen.yaml").write_text(text.replace(old, new), encoding="utf-8")
    git(folder, "commit", "-qam", "change")


def test_the_date_is_that_of_the_commit_which_last_touched_the_project(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GIT_COMMITTER_DATE", "2026-05-05T12:00:00 +0000")
    commit(robot.parent, {"readme": "of no meaning to the agreement"})
    assert "- **Date:** 2026\\-03-01\n" in agree(run, robot)
    assert "this document of 2026" in agree(run, robot)


def test_what_is_not_committed_has_no_date_but_the_one_that_is_asked_for(run: Run, robot: Path, tmp_path: Path) -> None:
    (robot / "archgen.yaml").write_text(ROBOT.replace("Mini", "Maxi"), encoding="utf-8")
    assert "**Date:**" not in agree(run, robot)
    assert "**Date:** 2026\\-12" in agree(run, robot, "--date", "2026-12-24")
    alone = tmp_path / "alone"
    alone.mkdir()
    (alone / "archgen.yaml").write_text(ROBOT, encoding="utf-8")
    assert "**Date:**" not in agree(run, alone)


@pytest.mark.parametrize("date", ["2026-02-30", "20260301", "2026-3-1", "tomorrow", "", "2026-W10-1"])
def test_what_is_no_date_is_wrong_usage(run: Run, robot: Path, date: str) -> None:
    ran = run("interfaces", robot, "--between", "a", "b", "--date", date)
    assert (ran.status, ran.out) == (2, "")
    assert f"--date: `{date}` is no date: write year, month and day, such as 2026-03-31" in ran.err


def test_without_a_signature_an_interface_has_just_its_version(run: Run, robot: Path) -> None:
    git(robot, "tag", "v1")
    git(robot, "tag", "signed/a-c/1")
    git(robot, "tag", "signed/a-b")
    markdown = agree(run, robot)
    assert versions(markdown) == ["V", "V", "V"]
    assert "Signed before" not in markdown


@pytest.mark.parametrize("name", ["signed/a-b/2026-03", "signed/b-a/x/y"])
def test_a_signed_tag_says_which_interfaces_are_as_they_were_signed(run: Run, robot: Path, name: str) -> None:
    git(robot, "tag", "-a", name, "-m", "In Pisa, by Ada | Ben\n\nmore")
    change(robot, "rate: 10 Hz", "rate: 5 Hz")
    change(robot, "scan: lidar.scan}}}}", "scan: lidar.scan, more: lidar.scan}}}}")
    markdown = agree(run, robot)
    assert versions(markdown) == [
        f"V, changed since {name} (V), where it was V",
        f"V, as signed at {name} (V)",
        f"V, as signed at {name} (V)",
    ]
    assert "| V<br>changed |" in re.sub(r"\b[0-9a-f]{6}\b", "V", markdown)
    assert f"| `{name}` | 2026" in markdown
    assert "In Pisa, by Ada \\| Ben |" in markdown


def test_the_newest_signature_in_the_history_counts(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    git(robot, "tag", "-a", "signed/a-b/z1", "-m", "first")
    change(robot, "rate: 10 Hz", "rate: 5 Hz")
    monkeypatch.setenv("GIT_COMMITTER_DATE", "2026-04-01T12:00:00 +0000")
    git(robot, "tag", "-a", "signed/a-b/a2", "-m", "second")
    assert all("as signed at signed/a-b/a2" in version for version in versions(agree(run, robot)))
    git(robot, "checkout", "-q", "signed/a-b/z1")
    markdown = agree(run, robot)
    assert all("as signed at signed/a-b/z1" in version for version in versions(markdown))
    assert "signed/a-b/a2" not in markdown, "an older state knows nothing of what was signed later"


def test_an_interface_that_was_not_signed_says_so(run: Run, robot: Path) -> None:
    git(robot, "tag", "signed/a-b/1")
    change(robot, "{stop: Stop}", "{stop: Stop, new: Stop}")
    change(robot, "{stop: eye.stop,", "{stop: eye.stop, new: eye.new,")
    assert any("V, new since what was signed at signed/a-b/1 (V)" in version for version in versions(agree(run, robot)))


def test_what_was_signed_is_found_where_the_project_lay_then(run: Run, robot: Path) -> None:
    git(robot, "tag", "signed/a-b/1")
    git(robot.parent, "mv", "robot", "arch")
    git(robot.parent, "commit", "-qm", "moved")
    moved = robot.parent / "arch"
    assert versions(agree(run, moved)) == 3 * ["V, as signed at signed/a-b/1 (V)"]
    ran = run("interfaces", moved, "--between", "a", "b", "--signed", "signed/a-b/1")
    assert (ran.status, ran.err.split(" (")[0]) == (0, "as signed at signed/a-b/1")


def test_a_signature_that_cannot_be_read_is_told(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(ROBOT + "x: [\n", encoding="utf-8")
    git(robot, "commit", "-qam", "broken")
    git(robot, "tag", "signed/a-b/1")
    change(robot, "x: [\n", "")
    markdown = agree(run, robot)
    assert "What was signed at signed/a-b/1 cannot be read, so nothing is said of its versions." in markdown
    assert versions(markdown) == ["V", "V", "V"]


@pytest.mark.parametrize(
    ("old", "new", "status", "lines"),
    try_some(
        [
            ("Alpha", "Alpha Ltd", 0, ["as signed at v1"]),
            ("lidar_driver", "driver", 0, ["as signed at v1"]),
            ("rate: 10 Hz", "period: 0.1 s", 0, ["as signed at v1"]),
            ("deadline: 200 ms", "deadline: 0.2 s", 0, ["as signed at v1"]),
            ("max_gap: 9 s", "max_gap: 9000 ms", 0, ["as signed at v1"]),
            (
                "{scan: {qos: sensor_data}}",
                "{scan: {qos: {reliability: best_effort, depth: 5}}}",
                0,
                ["as signed at v1"],
            ),
            ("/scan, qos: sensor_data", "/scan, qos: {reliability: best_effort, depth: 5}", 0, ["as signed at v1"]),
            ("size: 1 kB", "size: 1000 B", 0, ["as signed at v1"]),
            ("lidar: {", "lidar: {title: Laser, ", 0, ["as signed at v1"]),
            (
                "{R-1: {title: Stops in time}}",
                "{R-1: {title: Stops in time, description: always}}",
                0,
                ["as signed at v1"],
            ),
            (
                "wcet: 20 ms",
                "wcet: 25 ms",
                0,
                [
                    "as signed at v1",
                    "expected otherwise now, promised by nobody:",
                    "  `sense.eye.stop`: Largest gap (expected) was signed as 125 ms, and is 130 ms",
                    "  `sense.eye.stop`: Chain Halt (expected) was signed as 128 ms; met, and is 133 ms; met",
                ],
            ),
            (
                "rate: 10 Hz",
                "rate: 8 Hz",
                1,
                [
                    "not as signed at v1:",
                    "  `sense.lidar.scan` (version V, V was signed)",
                    "    weaker: Rate (promised) was signed as 10 Hz · 100 ms, and is 8 Hz · 125 ms",
                ],
            ),
            (
                "wcet: 20 ms",
                "wcet: 200 ms",
                1,
                [
                    "not as signed at v1:",
                    "  `sense.eye.stop` (version V, as signed)",
                    "    weaker: Deadline of Halt was signed as 300 ms, and is 300 ms, missed",
                    "    Contradiction was not signed: The QoS deadline of 200 ms that eye_node promises may not be kept: there is no bound.",
                    # Each of the four threads has a core to itself: the promise of `bell` holds beside it.
                    "expected otherwise now, promised by nobody:",
                    "  `sense.eye.stop`: Largest gap (expected) was signed as 125 ms, follows from when eye_node is activated and how long it takes, and is no bound: the host is overloaded",
                    "  `sense.eye.stop`: Chain Halt (expected) was signed as 128 ms; met, and is no bound: the host is overloaded; missed",
                ],
            ),
            (
                "deadline: 200 ms",
                "deadline: 150 ms",
                1,
                [
                    "not as signed at v1:",
                    "  `sense.eye.stop` (version V, V was signed)",
                    "    QoS offered (promised) was signed as default: reliable, depth 10, deadline 200 ms, and is default: reliable, depth 10, deadline 150 ms",
                ],
            ),
            (
                "deadline: 300 ms",
                "deadline: 400 ms",
                1,
                [
                    "not as signed at v1:",
                    "  `sense.eye.stop` (version V, as signed)",
                    "    weaker: Deadline of Halt was signed as 300 ms, and is 400 ms",
                ],
            ),
            (
                "{stop: eye.stop, alarm",
                "{alarm",
                1,
                ["not as signed at v1:", "  `sense.eye.stop` was signed, and is gone"],
            ),
        ],
        5,
    ),
)
def test_promises_bind_and_expectations_are_told(  # noqa: PLR0913, PLR0917 - the cases
    run: Run, robot: Path, old: str, new: str, status: int, lines: list[str]
) -> None:
    git(robot, "tag", "v1")
    change(robot, old, new)
    ran = run("interfaces", robot, "--between", "a", "b", "--signed", "v1")
    words = re.sub(r" \(V\)", "", re.sub(r"\b[0-9a-f]{6,7}\b", "V", ran.err)).splitlines()
    assert (ran.status, words[: len(lines)]) == (status, lines)
    assert len(words) == len(lines) or words[len(lines)].startswith("expected otherwise")


def test_what_is_weaker_comes_first(run: Run, robot: Path) -> None:
    git(robot, "tag", "v1")
    change(robot, "topic: /stop", "topic: /halt")
    change(robot, "rate: 10 Hz", "rate: 8 Hz")
    ran = run("interfaces", robot, "--between", "a", "b", "--signed", "v1")
    told = [line.split("`")[1] for line in ran.err.splitlines() if line.startswith("  `") and "version" in line]
    assert told == ["sense.lidar.scan", "sense.eye.stop"]


def test_what_the_launch_made_of_what_was_signed_is_told(run: Run, robot: Path) -> None:
    change(robot, "eye_node: {", "eye_node: {remaps: {/stop: /halt}, ")
    git(robot, "tag", "v1")
    git(robot, "tag", "signed/a-b/1")
    assert "V, as signed at signed/a-b/1 (V) (V by the rules of then)" in versions(agree(run, robot))
    ran = run("interfaces", robot, "--between", "a", "b", "--signed", "v1")
    assert (ran.status, ran.err.splitlines()[1:]) == (
        0,
        [
            (
                "warning: as signed by the words; since then it is known that `/stop` of `eye_node` runs on `/halt` "
                "(archgen.yaml:17:23), in the signed version too"
            )
        ],
    )
    change(robot, "/stop: /halt", "/stop: /stay")
    ran = run("interfaces", robot, "--between", "a", "b", "--signed", "v1")
    assert ran.status == 1
    assert "Topic was signed as /halt, and is /stay" in ran.err
