"""`archgen diff --breaking` where the policy asks whose elements a change edits: the table of the gate, row by row."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests import repositories
from tests.cli.conftest import Ran, Run
from tests.property_sizes import list_seeds, try_some

PROJECT = {
    "archgen.yaml": """\
archgen: 1
project: {id: hull}
ros: {distro: jazzy}
review: {breaking: {wire: error, promise: error, meaning: error, source: note, foreign: error}}
partners:
  norsk: {title: Norsk, reviewers: ["@nora", nora@norsk.example]}
  aegir: {title: Aegir, reviewers: ["@alva", alva@aegir.example]}
  ligur: {title: Ligur, reviewers: "@lea"}
types: {Charge: std_msgs/msg/Float32, Stop: std_msgs/msg/Bool, Leak: std_msgs/msg/Float64}
hosts: {pc: {cores: 4}}
""",
    "groups/sense.yaml": """\
groups:
  sense:
    owner: norsk
    components:
      leak_detector: {outputs: {leak: Leak}}
      beacon: {outputs: {beat: Charge}}
""",
    "groups/watch.yaml": """\
groups:
  watch:
    owner: aegir
    components:
      safety: {inputs: {leak: leak_detector.leak}, outputs: {stop: Stop}}
      console: {inputs: {beat: beacon.beat}}
      logbook: {owner: [aegir, ligur], inputs: {beat: beacon.beat}}
""",
    "groups/drive.yaml": """\
groups:
  drive:
    owner: ligur
    components:
      follower: {inputs: {stop: safety.stop}}
""",
    "nodes.yaml": """\
nodes:
  detector: {implements: leak_detector, host: pc, timing: {rate: 10 Hz}, publishes: {leak: {topic: /leak, qos: {reliability: reliable}}}}
  beacon: {implements: beacon, host: pc, timing: {rate: 1 Hz}, publishes: {beat: {topic: /beat}}}
  safety: {implements: safety, package: aegir_safety, host: pc, subscribes: {leak: {qos: {reliability: reliable}}}, publishes: {stop: {topic: /safety}}}
  console: {implements: console, host: pc}
  logbook: {implements: logbook, host: pc}
  follower: {implements: follower, host: pc, parameters: {max_speed: 0.3}}
""",
}
Edits = Mapping[str, tuple[str, str]]
"""For each file the words that are replaced; a file that is not there is written."""
NODES, WATCH, SENSE, TOP = "nodes.yaml", "groups/watch.yaml", "groups/sense.yaml", "archgen.yaml"


def edit(top: Path, edits: Edits, mail: str = "who@nowhere.example") -> None:
    """Commit edits as somebody."""
    files = {}
    for name, (old, new) in edits.items():
        text = (top / name).read_text(encoding="utf-8") if (top / name).exists() else old
        assert old in text
        files[name] = text.replace(old, new)
    repositories.commit(top, files, author=f"Somebody <{mail}>")


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Make a repository on a branch of its own."""
    top = repositories.repository(tmp_path / "hull", PROJECT)
    repositories.git(top, "checkout", "-q", "-b", "work")
    return top


def judge(run: Run, top: Path) -> Ran:
    """Judge the branch."""
    return run("diff", "main", "HEAD", "--breaking", "-C", top)


DELETE_CONSOLE = {
    WATCH: ("      console: {inputs: {beat: beacon.beat}}\n", ""),
    NODES: ("  console: {implements: console, host: pc}\n", ""),
}
SWAP_PACKAGE = {NODES: ("aegir_safety", "norsk_supervisor")}
OPTIONAL_LEAK = {
    "groups/norsk_notes.yaml": ("-", "groups: {watch: {components: {safety: {inputs: {leak: {optional: true}}}}}}\n")
}
PLAN_CONSOLE = {NODES: ("  console: {implements", "  console: {status: planned, implements")}
LOWER_QOS = {
    NODES: (
        "subscribes: {leak: {qos: {reliability: reliable}}}",
        "subscribes: {leak: {qos: {reliability: best_effort}}}",
    )
}
FASTER = {NODES: ("max_speed: 0.3", "max_speed: 0.8")}
OWN_EDIT = {NODES: ("rate: 1 Hz", "rate: 2 Hz")}


@pytest.mark.parametrize(
    ("edits", "owner"),
    try_some(
        [
            (DELETE_CONSOLE, "Aegir"),
            (SWAP_PACKAGE, "Aegir"),
            (FASTER, "Ligur"),
            (OPTIONAL_LEAK, "Aegir"),
            # The first steps of what two pull requests would do.
            (LOWER_QOS, "Aegir"),
            (PLAN_CONSOLE, "Aegir"),
        ],
        3,
    ),
)
def test_nobody_edits_what_belongs_to_others(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch, edits: Edits, owner: str
) -> None:
    edit(robot, edits)
    for actor in ("nora", "stranger"):
        monkeypatch.setenv("GITHUB_ACTOR", actor)
        ran = judge(run, robot)
        assert (ran.status, f"breaks {owner} (foreign)" in ran.out) == (1, True)
        assert f"edits what belongs to {owner}, for whom `@{actor}` does not stand" in ran.out
    # Beside an edit of one's own, it is foreign as well.
    edit(robot, OWN_EDIT)
    assert judge(run, robot).status == 1


@pytest.mark.parametrize("edits", try_some([DELETE_CONSOLE, SWAP_PACKAGE, OPTIONAL_LEAK, LOWER_QOS, PLAN_CONSOLE], 2))
def test_who_stands_for_the_owner_may(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch, edits: Edits) -> None:
    edit(robot, edits)
    monkeypatch.setenv("GITHUB_ACTOR", "Alva")
    assert judge(run, robot).status == 0
    edit(robot, {TOP: ("cores: 4", "cores: 8")})
    assert judge(run, robot).status == 0
    edit(robot, FASTER)
    ran = judge(run, robot)
    assert ran.status == 1
    assert re.findall(r"breaks (.*) \(foreign\)", ran.out) == ["Ligur"]


def test_without_a_forge_the_mail_of_the_commits_tells_the_author(run: Run, robot: Path) -> None:
    edit(robot, SWAP_PACKAGE, "Alva@aegir.example")
    assert judge(run, robot).status == 0
    edit(robot, {NODES: ("norsk_supervisor", "other")}, "nora@norsk.example")
    ran = judge(run, robot)
    assert (ran.status, "nobody can say whether the author stands for Aegir" in ran.out) == (0, True)


def test_one_partners_elements_alone_are_a_warning_where_nobody_knows_the_author(run: Run, robot: Path) -> None:
    edit(robot, SWAP_PACKAGE)
    ran = judge(run, robot)
    assert ran.status == 0
    assert ran.out.endswith("\nwarning: 1 breaking change for Aegir (foreign)\n")
    edit(robot, {TOP: ("cores: 4", "cores: 8")})
    assert judge(run, robot).status == 1


def test_mails_of_another_partner_are_no_doubt(run: Run, robot: Path) -> None:
    edit(robot, SWAP_PACKAGE, "nora@norsk.example")
    assert judge(run, robot).status == 1


def test_co_owners_are_owners(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    edit(robot, {NODES: ("  logbook: {implements: logbook", "  logbook: {package: books, implements: logbook")})
    for actor, status in (("lea", 0), ("alva", 0), ("nora", 1)):
        monkeypatch.setenv("GITHUB_ACTOR", actor)
        assert judge(run, robot).status == status, actor
    accepted = "review: {accepted: {logbook: {key: package, reason: fine}}}\n"
    edit(robot, {"review/ligur.yaml": ("-", accepted)}, "lea@users.noreply.github.com")
    write_event(robot, monkeypatch, user="nora", fork=False)
    assert judge(run, robot).status == 0


def write_event(top: Path, monkeypatch: pytest.MonkeyPatch, *, user: str, fork: bool) -> None:
    """Say, as GitHub does, who opened the pull request."""
    head, base = {"full_name": "fork/hull" if fork else "o/hull"}, {"full_name": "o/hull"}
    event = top.parent / "event.json"
    event.write_text(
        json.dumps({"pull_request": {"user": {"login": user}, "head": {"repo": head}, "base": {"repo": base}}})
    )
    monkeypatch.setenv("GITHUB_EVENT_PATH", str(event))


def test_an_update_of_the_branch_by_the_owner_makes_nobody_the_author(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    edit(robot, SWAP_PACKAGE)
    write_event(robot, monkeypatch, user="nora", fork=False)
    monkeypatch.setenv("GITHUB_ACTOR", "alva")
    assert judge(run, robot).status == 1


def test_new_elements_in_nobodys_group_or_ones_own_are_fine(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    new = "groups: {lab: {components: {probe: {outputs: {x: Leak}}}}}\ntypes: {Probe: std_msgs/msg/Int8}\n"
    edit(
        robot,
        {SENSE: ("beat: Charge}}\n", "beat: Charge}}\n      lamp: {outputs: {on: Stop}}\n"), "lab.yaml": ("-", new)},
    )
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    assert judge(run, robot).status == 0
    edit(robot, {WATCH: ("      safety:", "      spy: {inputs: {leak: leak_detector.leak}}\n      safety:")})
    ran = judge(run, robot)
    assert (ran.status, "component `watch.spy` of Aegir" in ran.out) == (1, True)


def test_references_that_follow_a_rename_are_no_edits(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    edit(
        robot,
        {
            SENSE: ("beacon:", "lighthouse:"),
            NODES: ("implements: beacon", "implements: lighthouse"),
            WATCH: ("beacon.beat", "lighthouse.beat"),
        },
    )
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    ran = judge(run, robot)
    assert (ran.status, "(foreign)" in ran.out) == (0, False)


def test_another_source_is_an_edit_of_its_reader(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    edit(
        robot,
        {
            SENSE: ("{beat: Charge}", "{beat: Charge, other: Charge}"),
            WATCH: ("console: {inputs: {beat: beacon.beat}}", "console: {inputs: {beat: beacon.other}}"),
        },
    )
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    ran = judge(run, robot)
    assert (ran.status, "breaks Aegir (foreign)" in ran.out) == (1, True)


def test_reviewers_count_as_they_were_before_the_change(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    edit(robot, {TOP: ('["@alva",', '["@alva", "@nora",')} | SWAP_PACKAGE)
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    ran = judge(run, robot)
    assert ran.status == 1
    assert "`@nora` does not stand" in ran.out


def test_the_files_of_the_repository_say_nobody_else(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mailmap = "Alva <alva@aegir.example> <nora@norsk.example>\n"
    edit(robot, SWAP_PACKAGE | {".mailmap": ("-", mailmap), ".env": ("-", "GITHUB_ACTOR=alva\n")}, "nora@norsk.example")
    assert judge(run, robot).status == 1
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    # A commit may say anything of its author: the forge knows better.
    edit(robot, {NODES: ("norsk_supervisor", "other")}, "alva@aegir.example")
    assert judge(run, robot).status == 1


ACCEPTED = re.compile(r"      # (review/\w+\.yaml)\n((?:      [^#\n].*\n)+)")


def copy_entries(ran: Ran) -> dict[str, str]:
    """Give the files that the output tells to write."""
    return {file: re.sub(r"(?m)^ {6}", "", text) for file, text in ACCEPTED.findall(ran.out)}


def test_the_owner_accepts_what_it_is_shown_and_nothing_else(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    edit(robot, FASTER | OPTIONAL_LEAK)
    write_event(robot, monkeypatch, user="nora", fork=False)
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    entries = copy_entries(judge(run, robot))
    assert sorted(entries) == ["review/aegir.yaml", "review/ligur.yaml"]
    for file, text in entries.items():
        # Written by the author of the request it is no agreement, by the reviewer it is.
        edit(robot, {file: (text, text)}, "nora@norsk.example")
        assert judge(run, robot).status == 1
    assert "none of its `reviewers` wrote it" in judge(run, robot).out
    repositories.git(robot, "reset", "-q", "--hard", "HEAD~2")
    edit(robot, {"review/aegir.yaml": (entries["review/aegir.yaml"],) * 2}, "alva@aegir.example")
    edit(robot, {"review/ligur.yaml": (entries["review/ligur.yaml"],) * 2}, "7+lea@users.noreply.github.com")
    assert judge(run, robot).status == 0
    # From a fork anybody may write any address.
    write_event(robot, monkeypatch, user="nora", fork=True)
    assert judge(run, robot).status == 1
    write_event(robot, monkeypatch, user="nora", fork=False)
    edit(robot, {NODES: ("max_speed: 0.8", "max_speed: 3.0")})
    ran = judge(run, robot)
    assert (ran.status, "agreed to another change than this one" in ran.out) == (1, True)


def test_what_waits_in_a_queue_was_judged_before(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    edit(robot, SWAP_PACKAGE)
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    monkeypatch.setenv("GITHUB_EVENT_NAME", "merge_group")
    assert judge(run, robot).status == 0


def test_the_actor_of_gitlab(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    edit(robot, SWAP_PACKAGE)
    for login, status in (("nora", 1), ("alva", 0)):
        monkeypatch.setenv("GITLAB_USER_LOGIN", login)
        assert judge(run, robot).status == status


def test_who_is_in_a_team_only_the_forge_knows(run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    repositories.git(robot, "checkout", "-q", "main")
    edit(robot, {TOP: ('["@alva", alva@aegir.example]', '"@o/aegir"')})
    repositories.git(robot, "checkout", "-q", "-B", "work")
    edit(robot, SWAP_PACKAGE)
    for actor, status in (("alva", 0), ("nora", 1)):
        monkeypatch.setenv("GITHUB_ACTOR", actor)
        ran = judge(run, robot)
        assert (ran.status, "(foreign)" in ran.out) == (status, True), actor


def test_a_type_of_ones_own_changes_no_instance_of_others(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    types = "component_types: {lamp: {owner: norsk, timing: {rate: 1 Hz}, outputs: {on: Stop}}}\n"
    instance = (
        "groups: {light: {owner: aegir, components: {red: {is: lamp}, green: {is: lamp, timing: {rate: 5 Hz}}}}}\n"
    )
    top = repositories.repository(tmp_path / "lamps", PROJECT | {"types.yaml": types, "groups/light.yaml": instance})
    repositories.git(top, "checkout", "-q", "-b", "work")
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    edit(top, {"types.yaml": ("rate: 1 Hz", "rate: 2 Hz")})
    ran = judge(run, top)
    assert (ran.status, "(foreign)" in ran.out) == (0, False)
    edit(top, {"groups/light.yaml": ("rate: 5 Hz", "rate: 6 Hz")})
    assert judge(run, top).status == 1


def test_a_variant_that_writes_over_it_is_an_edit_too(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    variants = "variants: {deep: {changes: {nodes: {beacon: {timing: {rate: 3 Hz}}}}}}\n"
    top = repositories.repository(tmp_path / "deep", PROJECT | {TOP: PROJECT[TOP] + variants})
    repositories.git(top, "checkout", "-q", "-b", "work")
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    edit(top, {TOP: ("rate: 3 Hz", "rate: 4 Hz")})
    assert judge(run, top).status == 0
    edit(top, {TOP: ("{nodes: {", "{nodes: {follower: {parameters: {max_speed: 0.8}}, ")})
    ran = judge(run, top)
    assert (ran.status, "in the variant `deep`" in ran.out) == (1, True)


OWN_EDITS: tuple[Edits, ...] = (
    {SENSE: ("leak: Leak", "leak: Leak, wet: Stop")},
    {SENSE: ("beacon:", "lighthouse:"), NODES: ("implements: beacon", "implements: lighthouse"), WATCH: ("beacon.beat", "lighthouse.beat")},
    {SENSE: ("  sense:", "  sensing:")},
    {NODES: ("  detector:", "  leak_node:")},
    {NODES: ("rate: 10 Hz", "rate: 20 Hz")},
    {NODES: ("timing: {rate: 1 Hz}", "package: norsk_beacon, timing: {rate: 1 Hz}")},
    {SENSE: ("leak_detector: {", "leak_detector: {title: Wet feet, ")},
    {SENSE: ("leak_detector: {", "leak_detector: {description: Finds water, ")},
    {TOP: ("title: Norsk,", "title: Norsk, contact: Nora,")},
    {"groups/more.yaml": ("-", "groups: {more: {owner: norsk, components: {spare: {outputs: {x: Leak}}}}}\n")},
    {"types.yaml": ("-", "types: {Depth: std_msgs/msg/Float32}\n")},
    {NODES: ("  beacon: {implements: beacon,", "  beacon: {parameters: {power: 3}, implements: beacon,")},
)  # fmt: skip


def test_types_in_somebodys_folder_are_his(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    types = "types: {Depth: {fields: {metres: float32}}, Speed: {message: std_msgs/msg/Float32, comment: In m/s}}\n"
    group = "groups: {light: {owner: aegir, components: {red: {outputs: {x: Depth, y: Speed}}}}}\n"
    top = repositories.repository(tmp_path / "hull", PROJECT | {"light/types.yaml": types, "light/groups.yaml": group})
    repositories.git(top, "checkout", "-q", "-b", "work")
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    for old, new in (
        ("In m/s", "In mm/s"),
        ("metres: float32", "metres: float64"),
        ("metres: float32", "depth: float32"),
    ):
        edit(top, {"light/types.yaml": (old, new)})
        ran = judge(run, top)
        assert (ran.status, "breaks Aegir (foreign)" in ran.out) == (1, True), new
        repositories.git(top, "reset", "-q", "--hard", "main")


@pytest.mark.parametrize("seed", list_seeds(20))
def test_a_partner_refactors_its_own_without_asking(
    run: Run, robot: Path, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    chosen = random.Random(seed).sample(OWN_EDITS, 4)  # noqa: S311 - no secret
    monkeypatch.setenv("GITHUB_ACTOR", "nora")
    for edits in chosen:
        # Of what an earlier one has renamed, nothing is left to edit.
        texts = {name: (robot / name).read_text("utf-8") if (robot / name).exists() else "-" for name in edits}
        if all(old in texts[name] for name, (old, _) in edits.items()):
            edit(robot, edits)
    ran = judge(run, robot)
    assert "(foreign)" not in ran.out
    assert ran.status == 0


def test_a_second_commit_is_not_covered_by_what_was_accepted_of_the_first(run: Run, tmp_path: Path) -> None:
    message, text = "msg/hull_msgs/msg/Leak.msg", "float32 level\nint32 compartment\n"
    files = PROJECT | {
        message: text,
        TOP: PROJECT[TOP].replace("foreign: error", "foreign: off").replace("std_msgs/msg/Float64", "hull_msgs/msg/Leak").replace("distro: jazzy", "distro: jazzy, interfaces: [msg/**/*.msg]"),
    }  # fmt: skip
    top = repositories.repository(tmp_path / "leak", files)
    repositories.git(top, "checkout", "-q", "-b", "work")
    edit(top, {message: ("level\n", "level\nfloat32 humidity\n")})
    for entry in ("key: fields, was: %s, reason: humidity is welcome", "key: fields, reason: humidity is welcome"):
        digits = re.findall(r"was: \"?(\w{6})", judge(run, top).out)[0]
        accepted = entry.replace("%s", digits)
        edit(top, {"review/aegir.yaml": ("-", f"review: {{accepted: {{hull_msgs/msg/Leak: {{{accepted}}}}}}}\n")})
        ran = judge(run, top)
        assert (ran.status, "humidity is welcome" in ran.out) == (0, True)
        assert ("which says no hash" in ran.out) == ("was" not in entry)
        edit(top, {message: ("int32 compartment\n", "")})
        ran = judge(run, top)
        assert (ran.status, "agreed to another change than this one" in ran.out) == (1, True)
        repositories.git(top, "reset", "-q", "--hard", "HEAD~2")


def test_a_hash_that_is_none_is_told_at_its_place(run: Run, robot: Path) -> None:
    edit(robot, {"review/aegir.yaml": ("-", "review: {accepted: {safety: {key: package, was: 12xy, reason: fine}}}\n")})
    ran = run("check", robot)
    assert ran.status == 1
    assert "review/aegir.yaml:1:49" in ran.out
    assert "copy the six digits that `archgen diff --breaking` prints" in ran.out
