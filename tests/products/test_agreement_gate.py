"""What reviews say unasked of what partners signed: what a change leaves, and signatures that are none."""

from __future__ import annotations

import random
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from archgen.products.compared_versions import compare_named_versions, read_versions
from archgen.products.merge_breaks import find_breaks
from tests.cli.conftest import Run, run  # noqa: F401 - the fixture
from tests.cli.test_signed_agreements import ROBOT
from tests.property_sizes import list_seeds, try_some
from tests.repositories import git, repository

STRICT = ROBOT.replace("types:", "review: {breaking: {agreement: error, promise: note, wire: note}}\ntypes:", 1)
FILE = "agreements/a-b.yaml"
BOTH = ("--by", "a", "Ada Lo", "--by", "b", "Ben Bo")
Sign = Callable[..., None]


@pytest.fixture(scope="module")
def made_robot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = repository(
        tmp_path_factory.mktemp("made"),
        {"archgen.yaml": STRICT, "agreements/a-b.yaml": "agreements: {a-b: {terms: {notice: 30 days}}}"},
    )
    (root / FILE).write_text("agreements:\n  a-b:\n    terms:\n      notice: 30 days  # as always\n", encoding="utf-8")
    git(root, "config", "user.name", "Clerk")
    git(root, "config", "user.email", "clerk@x.org")
    git(root, "commit", "-qam", "terms")
    return root


@pytest.fixture
def robot(made_robot: Path, tmp_path: Path) -> Path:
    return shutil.copytree(made_robot, tmp_path, dirs_exist_ok=True)


@pytest.fixture
def sign(run: Run, robot: Path) -> Sign:  # noqa: F811 - the fixture
    """Give a function that signs and commits what that writes."""

    def call(*words: str, day: str = "2026-03-01") -> None:
        ran = run(
            "sign", "a", "b", "-C", robot, "-o", robot / "archgen-out" / "a-b.md", "--date", day, *(words or BOTH)
        )
        assert ran.status == 0, ran.err
        git(robot, "add", FILE)
        git(robot, "commit", "-qm", "signed")

    return call


def edit(robot: Path, old: str, new: str, file: str = "archgen.yaml") -> None:
    text = (robot / file).read_text(encoding="utf-8")
    assert old in text
    (robot / file).write_text(text.replace(old, new), encoding="utf-8")
    git(robot, "add", file)
    git(robot, "commit", "-qm", "edit")


def judge(robot: Path, base: str = "base") -> list[str]:
    """Give what of an agreement would not be as signed since `base`: severity, place and words."""
    versions = read_versions(base, None, robot)
    comparison = compare_named_versions(*versions)
    found = [each for each in find_breaks(comparison, versions[1].checked_project) if "(agreement" in each.message]
    assert comparison.is_refused == bool(found)
    digits = re.compile(r"\b[0-9a-f]{6,7}\b")
    return [f"{each.severity} {each.span.file}:{each.span.line} {digits.sub('V', each.message)}" for each in found]


def test_a_change_leaves_what_was_signed_until_both_sign_again(robot: Path, sign: Sign) -> None:
    sign()
    git(robot, "branch", "base")
    edit(robot, "rate: 10 Hz", "rate: 8 Hz")
    assert judge(robot) == [
        (
            f"error {FILE}:13 breaks Alpha and Beta (agreement): of the agreement `a-b` of 2026-03-01 1 of 3 interfaces "
            "would not be as signed: mend it, or let both sign again (`archgen sign a b`); this changes what was signed of "
            "`sense.lidar.scan` (weaker: Rate (promised) was signed as 10 Hz · 100 ms, and is 8 Hz · 125 ms)"
        )
    ]
    sign(day="2026-04-01")
    assert judge(robot) == []
    edit(robot, "rate: 8 Hz", "rate: 7 Hz")
    assert "of the agreement `a-b` of 2026-04-01 1 of 3" in judge(robot)[0]


@pytest.mark.parametrize(
    ("old", "new"),
    try_some(
        [
            ("Alpha", "Alpha Ltd"),
            ("lidar_driver", "driver"),
            ("rate: 10 Hz", "period: 0.1 s"),
            ("wcet: 20 ms", "wcet: 21 ms"),
        ],
        2,
    ),
)
def test_what_leaves_nothing_is_silent(robot: Path, sign: Sign, old: str, new: str) -> None:
    sign()
    git(robot, "branch", "base")
    edit(robot, old, new)
    assert judge(robot) == []


@pytest.mark.parametrize(
    ("old", "new", "told"),
    try_some(
        [
            ("deadline: 300 ms", "deadline: 400 ms", "weaker: Deadline of Halt"),
            ("wcet: 20 ms", "wcet: 200 ms", "weaker: Deadline of Halt was signed as 300 ms, and is 300 ms, missed"),
            ("{stop: eye.stop, alarm", "{alarm", "`sense.eye.stop` (was signed, and is gone)"),
            (
                "outputs: {stop: Stop}",
                "outputs: {stop: {type: Stop, description: Halts}}",
                "Meaning was not signed: Halts",
            ),
            ("topic: /stop", "topic: /halt", "Topic was signed as /stop, and is /halt"),
        ],
        2,
    ),
)
def test_whatever_was_signed_is_held(robot: Path, sign: Sign, old: str, new: str, told: str) -> None:
    sign()
    git(robot, "branch", "base")
    edit(robot, old, new)
    (finding,) = judge(robot)
    assert told in finding


def test_what_was_left_before_is_no_news(robot: Path, sign: Sign) -> None:
    sign()
    edit(robot, "rate: 10 Hz", "rate: 8 Hz")
    git(robot, "branch", "base")
    edit(robot, "wcet: 20 ms", "wcet: 21 ms")
    assert judge(robot) == []
    edit(robot, "topic: /stop", "topic: /halt")
    (finding,) = judge(robot)
    assert "1 of 3" in finding
    assert "sense.lidar.scan" not in finding


def test_words_are_signed_too(run: Run, robot: Path, sign: Sign) -> None:  # noqa: F811 - the fixture
    sign()
    git(robot, "branch", "base")
    edit(robot, "30 days", "3 days", FILE)
    (finding,) = judge(robot)
    assert "changes what was signed of the terms (Notice of changes)" in finding
    ran = run("interfaces", robot, "--between", "a", "b", "--signed", "signed/a-b/2026-03-01")
    assert ran.status == 1
    assert "  terms: Notice of changes is not as it was signed" in ran.err.splitlines()
    assert "Terms that are not what they were at signed/a" in ran.out.replace("\\", "")


def test_a_variant_is_held_as_well(robot: Path, sign: Sign) -> None:
    edit(robot, "hosts:", "variants: {slow: {changes: {nodes: {lidar_driver: {timing: {rate: 5 Hz}}}}}}\nhosts:")
    sign()
    git(robot, "branch", "base")
    edit(robot, "rate: 5 Hz", "rate: 4 Hz")
    (finding,) = judge(robot)
    assert "would not be as signed, in the variant `slow`" in finding
    assert "5 Hz · 200 ms, and is 4 Hz" in finding


def test_a_variant_is_not_told_what_the_project_leaves_already(robot: Path, sign: Sign) -> None:
    edit(robot, "hosts:", "variants: {slow: {changes: {nodes: {lidar_driver: {timing: {rate: 5 Hz}}}}}}\nhosts:")
    sign()
    git(robot, "branch", "base")
    edit(robot, "topic: /stop", "topic: /halt")
    assert len(judge(robot)) == 1


def test_a_signature_counts_in_its_own_file_alone(robot: Path, sign: Sign) -> None:
    git(robot, "branch", "base")
    sign()
    git(robot, "mv", FILE, "more.yaml")
    git(robot, "commit", "-qm", "moved")
    (finding,) = judge(robot)
    assert finding.startswith("error more.yaml:5 ")
    assert f"the signature stands in `more.yaml`: it counts in `{FILE}` alone" in finding


def test_a_partner_with_another_id_signs_again(robot: Path, sign: Sign) -> None:
    sign()
    git(robot, "branch", "base")
    edit(robot, "a: Alpha", "alpha: Alpha")
    edit(robot, "owner: a", "owner: alpha")
    git(robot, "mv", FILE, "agreements/alpha-b.yaml")
    edit(robot, "a-b:", "alpha-b:", "agreements/alpha-b.yaml")
    (finding,) = judge(robot)
    assert "`alpha` did not sign what takes the place of `alpha-b` of 2026-03-01" in finding


def test_a_signature_of_one_binds_nobody(robot: Path, sign: Sign) -> None:
    sign("--by", "a", "Ada Lo")
    git(robot, "branch", "base")
    edit(robot, "rate: 10 Hz", "rate: 8 Hz")
    assert judge(robot) == []
    git(robot, "checkout", "-q", "base")
    sign("--by", "b", "Ben Bo", day="2026-03-05")
    assert 'a: "Ada Lo, 2026-03-01"\n        b: "Ben Bo, 2026-03-05"' in (robot / FILE).read_text(encoding="utf-8")
    git(robot, "branch", "both")
    edit(robot, "rate: 10 Hz", "rate: 8 Hz")
    assert "of 2026-03-05 1 of 3" in judge(robot, "both")[0]


def test_one_alone_does_not_take_the_place_of_both(robot: Path, sign: Sign) -> None:
    sign()
    git(robot, "branch", "base")
    edit(robot, "rate: 10 Hz", "rate: 8 Hz")
    sign("--by", "a", "Ada Lo", day="2026-04-01")
    (finding,) = judge(robot)
    assert finding.startswith(f"error {FILE}:10 ")
    assert "`b` did not sign what takes the place of `a-b` of 2026-03-01" in finding


@pytest.mark.parametrize(
    ("pattern", "new", "line", "told"),
    try_some(
        [
            (
                r'sense.lidar.scan: "\w+"',
                'sense.lidar.scan: "123456"',
                17,
                "the signature holds version V of `sense.lidar.scan`, and V is at V",
            ),
            (
                r'        sense.lidar.scan: "\w+"\n',
                "",
                13,
                "the signature holds no `sense.lidar.scan` of `a`, and V is at V",
            ),
            (
                r'terms: "\w+"',
                'terms: "123456"',
                9,
                "the digits of the terms are not those of what was agreed in words",
            ),
            (r'revision: "\w+"', f'revision: "{40 * "a"}"', 7, "it moved"),
            (r'revision: "\w+"', "revision:", 5, "the signature names no commit"),
            ("rules: 2", "rules: 9", 6, "by rules 9, which this version of archgen does not know"),
            ("2026-03-01\n", "2026-03-02\n", 8, ""),
        ],
        2,
    ),
)
def test_a_signature_that_was_edited_is_told_at_its_line(  # noqa: PLR0913, PLR0917 - the cases
    robot: Path, sign: Sign, pattern: str, new: str, line: int, told: str
) -> None:
    sign()
    git(robot, "branch", "base")
    text = (robot / FILE).read_text(encoding="utf-8")
    assert re.search(pattern, text)
    (robot / FILE).write_text(re.sub(pattern, new, text, count=1), encoding="utf-8")
    found = judge(robot)
    if told:
        assert told in found[0]
        assert abs(int(found[0].split(":")[1].split(" ")[0]) - line) <= 1, found[0]
    else:
        assert found == []  # a tag that is not here says nothing; the commit is what was signed


def test_a_tag_that_moved_is_told(robot: Path, sign: Sign) -> None:
    sign()
    git(robot, "branch", "base")
    edit(robot, "Alpha", "Alpha Ltd")
    git(robot, "tag", "-fam", "x", "signed/a-b/2026-03-01", "HEAD")
    (finding,) = judge(robot)
    assert finding.startswith(f"error {FILE}:7 ")
    assert "the tag `signed/a-b/2026-03-01` stands at V, and V was signed: it moved" in finding


def test_without_the_signed_commit_the_versions_count(robot: Path, sign: Sign) -> None:
    sign()
    git(robot, "tag", "-d", "signed/a-b/2026-03-01")
    text = (robot / FILE).read_text(encoding="utf-8")
    (robot / FILE).write_text(re.sub(r'revision: "\w+"', f'revision: "{40 * "a"}"', text), encoding="utf-8")
    git(robot, "commit", "-qam", "as after a squash")
    git(robot, "branch", "base")
    edit(robot, "rate: 10 Hz", "rate: 8 Hz")
    (finding,) = judge(robot)
    assert "changes what was signed of `sense.lidar.scan` (version V, V was signed)" in finding


def test_a_withdrawal_needs_the_word_of_both(robot: Path, sign: Sign) -> None:
    sign()
    git(robot, "branch", "base")
    git(robot, "rm", "-q", FILE)
    git(robot, "commit", "-qm", "gone")
    (finding,) = judge(robot)
    assert "the agreement `a-b` of 2026-03-01 is withdrawn; this ends what both signed" in finding
    (robot / "review").mkdir()
    for name in ("a", "b"):
        words = "review: {accepted: {mini: {key: agreements.a-b, reason: the project is over}}}\n"
        (robot / "review" / f"{name}.yaml").write_text(words, encoding="utf-8")
    assert judge(robot) == []


def test_where_it_is_off_nobody_is_asked(robot: Path, sign: Sign) -> None:
    edit(robot, "agreement: error", 'agreement: "off"')
    sign()
    git(robot, "branch", "base")
    edit(robot, "rate: 10 Hz", "rate: 8 Hz")
    assert judge(robot) == []


EDITS = (
    ("Alpha", "Alpha Ltd"),
    ("lidar_driver", "driver"),
    ("wcet: 20 ms", "wcet: 21 ms"),
    ("wcet: 20 ms", "wcet: 200 ms"),
    ("rate: 10 Hz", "rate: 9 Hz"),
    ("rate: 10 Hz", "rate: 11 Hz"),
    ("max_gap: 9 s", "max_gap: 10 s"),
    ("deadline: 300 ms", "deadline: 100 ms"),
    ("deadline: 200 ms", "deadline: 100 ms"),
    ("topic: /scan", "topic: /laser"),
    ("size: 40 B", "size: 41 B"),
    ("Stops in time", "Stops at once"),
    ("alarm: bell.alarm, ", ""),
    ("scan: lidar.scan}}}}", "scan: {from: lidar.scan, freshness: 1 s}}}}}"),
    ("cores: 4", "cores: 1"),
    ("qos: sensor_data}}}", "qos: default}}}"),
    ("eye: {inputs", "eye: {title: Eyes, inputs"),
    ("message: std_msgs/msg/Header", "message: std_msgs/msg/Bool"),
)


@pytest.mark.parametrize("seed", list_seeds(4))
def test_whoever_leaves_what_was_signed_is_told(run: Run, robot: Path, sign: Sign, seed: int) -> None:  # noqa: F811
    """Where the base is as signed and the head is not, the change breaks an agreement; and nowhere else."""
    sign()
    chance, statuses = random.Random(seed), []  # noqa: S311 - the edits of a test
    for name, edits in (("base", chance.sample(EDITS[:3], 1)), ("head", chance.sample(EDITS, 2))):
        for old, new in edits:
            text = (robot / "archgen.yaml").read_text(encoding="utf-8")
            (robot / "archgen.yaml").write_text(text.replace(old, new, 1), encoding="utf-8")
        git(robot, "commit", "-q", "--allow-empty", "-am", name)
        git(robot, "branch", name)
        signed = run("interfaces", robot, "--between", "a", "b", "--signed", "signed/a-b/2026-03-01", "--keep-going")
        statuses.append("not as signed" in signed.err)
    assert [statuses[0], bool(judge(robot))] == [False, statuses[1]]
