"""The gate as a pull request meets it: what a branch does, the exit status of the review, and the comment's heading."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests import repositories
from tests.cli.conftest import Run
from tests.property_sizes import try_some

PROJECT = {
    "archgen.yaml": """\
archgen: 1
project: {id: mini}
partners: {a: A, b: B}
ros: {distro: jazzy, interfaces: ["msg/**/*.msg"]}
review: {breaking: error}
types: {Stop: {message: m_msgs/msg/Stop, size: 10 B}}
""",
    "a.yaml": """\
groups:
  sense:
    owner: a
    components:
      eye:
        timing: {rate: 10 Hz, wcet: 5 ms}
        inputs: {light: {external: Light, medium: physical, type: Light}}
        outputs: {stop: Stop}
""",
    "b.yaml": """\
groups:
  drive:
    owner: b
    components:
      base:
        timing: {rate: 50 Hz, wcet: 1 ms}
        inputs: {stop: sense.eye.stop}
        outputs: {wheels: {type: Torque, external: Wheels, medium: physical}}
chains: {halt: {through: [eye, base], deadline: 300 ms}}
""",
    "msg/m_msgs/msg/Stop.msg": "uint8 RESUME=0\nuint8 STOP=1\nuint8 what\n",
}
NO_STOP = ("a.yaml", "{stop: Stop}", "{}")
NO_READER = ("b.yaml", "{stop: sense.eye.stop}", "{}")
NO_CHAIN = ("b.yaml", "chains: {halt: {through: [eye, base], deadline: 300 ms}}\n", "")
SLOW = ("a.yaml", "10 Hz", "3 Hz")
LONGER = ("b.yaml", "deadline: 300 ms", "deadline: 500 ms")
Edit = tuple[str, str, str]


@pytest.fixture
def review(run: Run, tmp_path: Path) -> Callable[..., tuple[int, str]]:
    """Return a function that edits the project on a branch, and gives the review's status and the comment."""

    def edit_and_review(*edits: Edit, folder: str = "robot", **files: str) -> tuple[int, str]:
        top = repositories.repository(tmp_path, {f"robot/{name}": text for name, text in PROJECT.items()})
        repositories.git(top, "checkout", "-q", "-b", "branch")
        after = dict(PROJECT)
        for name, old, new in edits:
            assert old in after[name]
            after[name] = after[name].replace(old, new)
        if folder != "robot":
            (top / folder).parent.mkdir(exist_ok=True)
            repositories.git(top, "mv", "robot", folder)
        repositories.commit(top, {f"{folder}/{name}": text for name, text in (after | files).items()})
        ran = run("review", top / folder, "--base", "main", "--no-build", "-o", top / "out")
        return ran.status, (top / "out/comment.md").read_text(encoding="utf-8")

    return edit_and_review


BRANCHES: dict[str, tuple[list[Edit], int, str]] = {
    "an output is taken away": ([NO_STOP], 1, "### 1 change of the architecture in what could be read: breaks B, also concerns A"),
    "an output is taken away with its reader and the chain": (
        [NO_STOP, NO_READER, NO_CHAIN],
        1,
        "### 3 changes of the architecture: breaks A and B",
    ),
    "a reader turns away": ([NO_READER, ("b.yaml", ", deadline: 300 ms", "")], 1, "### 2 changes of the architecture: breaks A and B"),
    "constants swap values": (
        [("msg/m_msgs/msg/Stop.msg", "RESUME=0\nuint8 STOP=1", "RESUME=1\nuint8 STOP=0")],
        1,
        "### 2 changes of the architecture: breaks B, also concerns A",
    ),
    "a rate is lower, and high enough": ([("a.yaml", "10 Hz", "5 Hz")], 0, "### 1 change of the architecture: concerns A and B"),
    "a rate is higher": ([("a.yaml", "10 Hz", "20 Hz")], 0, "### 1 change of the architecture: concerns A and B"),
    "a rate is too low": ([SLOW], 1, "### 1 change of the architecture: breaks B, also concerns A"),
    "a rate is too low, and the deadline follows": ([SLOW, LONGER], 1, "### 2 changes of the architecture: breaks A and B"),
    "the policy is switched off": (
        [SLOW, ("archgen.yaml", "breaking: error", 'breaking: "off"')],
        1,
        "### 2 changes of the architecture: breaks B, also concerns A",
    ),
    "a field is added while the reader becomes optional": (
        [
            ("msg/m_msgs/msg/Stop.msg", "uint8 what\n", "uint8 what\nuint8 why\n"),
            ("b.yaml", "{stop: sense.eye.stop}", "{stop: {from: sense.eye.stop, optional: true}}"),
        ],
        1,
        "### 2 changes of the architecture: breaks B, also concerns A",
    ),
    "the producer is given to its reader": (
        [SLOW, ("a.yaml", "owner: a", "owner: b")],
        1,
        "### 2 changes of the architecture: breaks A and B",
    ),
    "a file cannot be read, and another one loses an output": (
        [NO_STOP, ("b.yaml", "300 ms}}\n", "300 ms}}\nx\n")],
        1,
        "### Cannot be judged: `b.yaml` cannot be read (1 certain change), breaks B, also concerns A",
    ),
    "a file cannot be read": (
        [("b.yaml", "300 ms}}\n", "300 ms}}\nx\n")],
        1,
        "### Cannot be judged: `b.yaml` cannot be read",
    ),
    "a reader is taken over in the author's own file": (
        [("a.yaml", "groups:\n", "groups:\n  drive: {components: {base: {owner: a}}}\n")],
        0,
        "### 1 change of the architecture: concerns A and B",
    ),
    "the output is given to its reader": (
        [("a.yaml", "owner: a", "owner: b")],
        0,
        "### 1 change of the architecture: concerns A and B",
    ),
    "a comment is added": ([("a.yaml", "owner: a", "owner: a  # Ann")], 0, "### No change of the architecture"),
}  # fmt: skip


@pytest.mark.parametrize(("edits", "status", "heading"), try_some(BRANCHES.values(), 6), ids=BRANCHES.keys())
def test_what_a_branch_does(
    review: Callable[..., tuple[int, str]], edits: list[Edit], status: int, heading: str
) -> None:
    found, comment = review(*edits)
    assert (comment.splitlines()[0], found) == (heading, status)


@pytest.mark.parametrize(("unread_key", "asks"), [("", True), ("x\n", False)])
def test_nobody_is_asked_to_accept_what_cannot_be_judged(
    review: Callable[..., tuple[int, str]], unread_key: str, *, asks: bool
) -> None:
    status, comment = review(NO_STOP, ("b.yaml", "300 ms}}\n", f"300 ms}}}}\n{unread_key}"))
    assert (status, "accepted:" in comment, "review/b.yaml" in comment) == (1, asks, asks)


def test_a_folder_that_is_renamed_hides_nothing(review: Callable[..., tuple[int, str]]) -> None:
    status, comment = review(SLOW, folder="arch/harvester")
    assert (comment.splitlines()[0], status) == ("### 1 change of the architecture: breaks B, also concerns A", 1)


def test_a_folder_that_is_renamed_with_the_project_in_it_hides_nothing(review: Callable[..., tuple[int, str]]) -> None:
    status, comment = review(SLOW, ("archgen.yaml", "id: mini", "id: maxi"), folder="arch")
    assert (": breaks B" in comment.splitlines()[0], status) == (True, 1)


def test_a_folder_that_is_renamed_alone_is_no_change(review: Callable[..., tuple[int, str]]) -> None:
    status, comment = review(folder="arch")
    assert (comment.splitlines()[0], status) == ("### No change of the architecture", 0)


@pytest.mark.parametrize(("policy", "status"), [("error", 1), ("warning", 0)])
def test_a_project_that_was_not_there_cannot_be_judged(run: Run, tmp_path: Path, policy: str, status: int) -> None:
    top = repositories.repository(tmp_path, {f"old/{name}": text for name, text in PROJECT.items()})
    repositories.git(top, "checkout", "-q", "-b", "branch")
    copy = {name: text.replace("breaking: error", f"breaking: {policy}") for name, text in PROJECT.items()}
    repositories.commit(top, {f"new/{name}": text for name, text in copy.items()})
    ran = run("review", top / "new", "--base", "main", "--no-build", "-o", top / "out")
    comment = (top / "out/comment.md").read_text(encoding="utf-8")
    assert (ran.status, comment.splitlines()[0]) == (status, "### Cannot be judged")
    assert "`new/archgen.yaml` does not exist in" in comment


def test_a_message_definition_in_another_package_breaks_who_uses_it(run: Run, tmp_path: Path) -> None:
    top = repositories.repository(tmp_path, PROJECT)
    (top / "msg/m_msgs/msg/Stop.msg").unlink()
    moved = {"archgen.yaml": PROJECT["archgen.yaml"].replace("m_msgs", "n_msgs")}
    repositories.commit(top, moved | {"msg/n_msgs/msg/Stop.msg": PROJECT["msg/m_msgs/msg/Stop.msg"]})
    ran = run("diff", "HEAD~1", "--breaking", "-C", top)
    assert ran.status == 1
    assert "breaks B (wire): message definition `m_msgs/msg/Stop` is called `n_msgs/msg/Stop` now" in ran.out


AGREED = "review: {accepted: {sense.eye.stop: {key: removed, reason: fine}}}\n"


@pytest.mark.parametrize("link", ["review", "review/b.yaml"])
@pytest.mark.parametrize("lists_sources", [True, False])
def test_nobody_agrees_through_a_link(run: Run, tmp_path: Path, link: str, *, lists_sources: bool) -> None:
    sources = "sources: [a.yaml, b.yaml]\n" if lists_sources else ""
    base = PROJECT | {
        "archgen.yaml": PROJECT["archgen.yaml"] + sources,
        "b.yaml": PROJECT["b.yaml"].partition("chains")[0],
    }
    top = repositories.repository(tmp_path, base)
    repositories.commit(top, {"a.yaml": base["a.yaml"].replace("{stop: Stop}", "{}"), "author/b.yaml": AGREED})
    (top / link).parent.mkdir(exist_ok=True)
    (top / link).symlink_to("author" if link == "review" else "../author/b.yaml")
    repositories.commit(top, {})
    in_tree, in_commit = (run("diff", *words, "--breaking", "-C", top) for words in (["HEAD~2"], ["HEAD~2", "HEAD"]))
    for ran in (in_tree, in_commit):
        assert ran.status == 1
        assert "accepted by B" not in ran.out
    (top / link).unlink()
    repositories.commit(
        top, {"review/b.yaml": AGREED, "b.yaml": base["b.yaml"].replace("{stop: sense.eye.stop}", "{}")}
    )
    agreed = run("diff", "HEAD~3", "--breaking", "-C", top)
    assert (agreed.status, "accepted by B: fine" in agreed.out) == (0, True)


def test_which_of_several_gone_projects_it_was_is_not_guessed_whatever_the_policy(run: Run, tmp_path: Path) -> None:
    decoy = {"decoy/archgen.yaml": "archgen: 1\nproject: {id: mini}\n"}
    top = repositories.repository(tmp_path, {f"robot/{name}": text for name, text in PROJECT.items()} | decoy)
    repositories.git(top, "checkout", "-q", "-b", "branch")
    repositories.git(top, "mv", "robot", "arch")
    repositories.git(top, "rm", "-q", "-r", "decoy")
    repositories.commit(top, {"arch/archgen.yaml": PROJECT["archgen.yaml"].replace("breaking: error", "main: main")})
    ran = run("review", top / "arch", "--base", "main", "--no-build", "-o", top / "out")
    assert (ran.status, "which of 2 others it was is not clear" in ran.err) == (2, True)
    assert (top / "out/comment.md").read_text(encoding="utf-8").startswith("### Cannot be judged")
