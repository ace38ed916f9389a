"""The verbs of partners: interfaces and owners. Formats, where they go, and what wrong usage is told."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.agreeing import DUO, written
from tests.cli.conftest import Run
from tests.property_sizes import try_some
from tests.repositories import git, repository


@pytest.fixture
def duo(tmp_path: Path) -> Path:
    return written(tmp_path / "duo")


def test_markdown_goes_to_the_terminal(run: Run, duo: Path) -> None:
    ran = run("interfaces", duo, "--between", "north", "south")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("# North Robotics and South Vision\n\nInterface agreement\n")
    assert [path.name for path in duo.iterdir()] == ["archgen.yaml"]


@pytest.mark.parametrize(
    ("words", "name", "start"),
    [
        (("-o", "a.docx"), "a.docx", b"PK"),
        (("-o", "a.HTM"), "a.HTM", b"<!DOCTYPE html>"),
        (("-o", "a.txt", "--format", "markdown"), "a.txt", b"# North"),
        (("--format", "html"), "duo/archgen-out/interfaces/north-south.html", b"<!DOCTYPE html>"),
    ],
)
def test_the_ending_says_the_format(  # noqa: PLR0913, PLR0917 - the fixtures and the cases
    run: Run, duo: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], name: str, start: bytes
) -> None:
    monkeypatch.chdir(duo.parent)
    ran = run("interfaces", duo, "--between", "north", "south", *words)
    assert (ran.status, ran.out) == (0, f"wrote {name} (3 interfaces)\n")
    assert (duo.parent / name).read_bytes().startswith(start)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--between", "north", "sout"), "there is no partner `sout`; did you mean `south`?"),
        (("--between", "north", "north"), "an agreement is between two partners, and `north` was given twice"),
        (("--between", "west", "south"), "nothing flows between `west` and `south`; `west` has interfaces with north"),
        (("--between", "north", "south", "-o", "a.pdf"), "the ending of `a.pdf` names no format"),
        (("--between", "north", "south", "--since", "v9"), "--since: "),
        (("--between", "north"), "Option '--between' requires 2 arguments"),
        ((), "Missing option '--between'"),
    ],
)
def test_wrong_usage(run: Run, duo: Path, words: tuple[str, ...], said: str) -> None:
    ran = run("interfaces", duo, *words)
    assert (ran.status, ran.out) == (2, "")
    assert said in ran.err
    assert [path.name for path in duo.iterdir()] == ["archgen.yaml"]


def test_since_an_unknown_revision_of_a_repository(run: Run, tmp_path: Path) -> None:
    folder = repository(tmp_path / "duo", {"archgen.yaml": DUO})
    ran = run("interfaces", folder, "--between", "north", "south", "--since", "v9")
    assert ran.status == 2
    assert "--since: there is no revision `v9`" in ran.err
    same = run("interfaces", folder, "--between", "north", "south", "--since", "HEAD")
    assert "> Nothing between the two has changed since HEAD (" in same.out


def test_errors_stop_it_unless_asked_otherwise(run: Run, tmp_path: Path) -> None:
    folder = written(tmp_path / "duo", DUO.replace("camera.image, planner", "camra.image, planner"))
    ran = run("interfaces", folder, "--between", "north", "south")
    assert (ran.status, ran.out) == (1, "")
    assert ran.err.endswith("Nothing was written. With --keep-going outputs are made of what is sound.\n")
    going = run("interfaces", folder, "--between", "north", "south", "--keep-going")
    assert going.status == 1
    assert "> The architecture has errors (1 error" in going.out


def test_owners(run: Run, duo: Path) -> None:
    ran = run("owners", duo)
    assert (ran.status, ran.err) == (0, "")
    lines = ran.out.splitlines()
    assert lines[0].split() == ["Partner", "groups", "components", "nodes", "files", "reviewers"]
    assert lines[1].split() == ["North", "Robotics", "(north)", "1", "4", "1", "1", "@duo/north"]
    assert "  components: seeing.camera, seeing.finder, moving.calibration, moving.watch" in lines


def test_files_of_libraries_and_messages_are_everybodys(run: Run, tmp_path: Path) -> None:
    project = (
        "archgen: 1\npartners: {p: {}}\nlibraries: {common: common}\nros: {interfaces: [robot_msgs/msg/*.msg]}\n"
        "groups: {a: {title: A, owner: p, components: {c: {is: common.eye}}}}\n"
    )
    library = "component_types: {eye: {functionality: Sees.}}\n"
    for name, text in (
        ("archgen.yaml", project),
        ("common/eye.yaml", library),
        ("robot_msgs/msg/Pose.msg", "float64 x\n"),
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    ran = run("owners", tmp_path)
    assert ran.status == 0
    assert ran.out.splitlines()[-3:] == [
        "",
        "All partners share:",
        "  files:      robot_msgs/msg/Pose.msg, common/eye.yaml",
    ]
    assert "/common/eye.yaml" in run("owners", tmp_path, "--format", "codeowners").out


def test_codeowners(run: Run, duo: Path) -> None:
    ran = run("owners", duo, "--format", "codeowners", "-o", duo / ".github" / "CODEOWNERS")
    assert ran.status == 0
    assert ran.err == (
        'warning: `west` owns files and has no reviewers: write `reviewers: "@organisation/team"` below `partners: west`\n'
    )
    both = "@duo/north @duo/south lee@south.example"
    assert (duo / ".github" / "CODEOWNERS").read_text(encoding="utf-8").splitlines()[3:] == [
        "",
        f"* {both}",
        "# /archgen.yaml: west without reviewers",
        "/archgen.yaml @duo/north @duo/south lee@south.example",
        "/review/north.yaml @duo/north",
        "/review/south.yaml @duo/south lee@south.example",
        "# /review/west.yaml: west without reviewers",
        *(
            f"{path} {both}"
            for path in ("/.github/", "/.gitlab/", "/.gitlab-ci.yml", "/CODEOWNERS", "/docs/CODEOWNERS")
        ),
    ]


def test_codeowners_of_a_broken_project_are_not_written(run: Run, broken: Path) -> None:
    ran = run("owners", broken, "--format", "codeowners")
    assert (ran.status, ran.out) == (1, "")
    assert "Nothing was written." in ran.err


def test_who_owns_what_stays_text(run: Run, tmp_path: Path) -> None:
    folder = written(
        tmp_path / "a", 'archgen: 1\npartners: {p: {title: "\\e[31m::error::x"}}\ngroups: {a: {title: A, owner: p}}\n'
    )
    ran = run("owners", folder)
    assert "\x1b" not in ran.out
    assert "␛[31m::error::x (p)" in ran.out


PAIR = """\
archgen: 1
partners: {certh: , sssa: }
groups:
  sensing:
    owner: certh
    components:
      camera: {title: Colour camera, functionality: Sees what stands in front of the robot., outputs: {image: Image}}
  display:
    owner: sssa
    components:
      screen: {inputs: {image: camera.image}}
types: {Image: {message: sensor_msgs/msg/Image}}
"""
NODES = "nodes:\n  cam: {implements: camera, publishes: {image: {topic: /image}}}\n  show: {implements: screen}\n"
RENAMES = [
    ("  camera:", "  colour_camera:"),
    ("camera.image", "colour_camera.image"),
    (": camera,", ": colour_camera,"),
]


def since_head(run: Run, folder: Path, text: str, *edits: tuple[str, str]) -> tuple[str, str]:
    """Commit a project, edit it, and return what `diff` and the agreement say of it since."""
    root = repository(folder, {"archgen.yaml": text})
    for old, new in edits:
        text = text.replace(old, new)
    (root / "archgen.yaml").write_text(text, encoding="utf-8")
    diff = run("diff", "HEAD", "-C", root)
    agreement = run("interfaces", root, "--between", "certh", "sssa", "--since", "HEAD")
    assert (diff.err, agreement.err) == ("", "")
    return diff.out, agreement.out


@pytest.mark.parametrize("nodes", ["", NODES])
def test_a_renamed_component_is_renamed_in_the_agreement_as_in_the_diff(run: Run, tmp_path: Path, nodes: str) -> None:
    diff, agreement = since_head(run, tmp_path / "pair", PAIR + nodes, *RENAMES)
    assert "component `sensing.camera` is called `colour_camera` now; for Sssa only ids change (source)\n" in diff
    assert "1 change (1 renamed)" in diff
    assert "): 1 renamed.\n" in agreement
    assert "| → renamed (was `sensing.camera.image`)" in agreement
    assert "| Name | → renamed | sensing.camera.image | sensing.colour\\_camera.image |" in agreement
    for word in ("added", "removed", "Removed"):
        assert word not in agreement


def test_a_topic_called_after_a_renamed_component_is_a_changed_term(run: Run, tmp_path: Path) -> None:
    nodes = NODES.replace("publishes: {image: {topic: /image}}", "host: pc") + "hosts: {pc: {cores: 1}}\n"
    _, agreement = since_head(run, tmp_path / "pair", PAIR + nodes, *RENAMES)
    assert "| Topic | \\~ changed | /sensing/camera/image | /sensing/colour\\_camera/image |" in agreement


def test_a_renamed_node_and_a_renamed_type_are_no_other_ends_and_no_other_type(run: Run, tmp_path: Path) -> None:
    edits = [
        ("cam:", "cam_driver:"),
        ("outputs: {image: Image}", "outputs: {image: Picture}"),
        ("{Image:", "{Picture:"),
    ]
    diff, agreement = since_head(run, tmp_path / "pair", PAIR + NODES, *edits)
    assert "2 changes (2 renamed)" in diff
    assert "| Type | → renamed | Image | Picture |" in agreement
    for word in ("added", "removed"):
        assert word not in agreement


def test_a_renamed_partner_keeps_the_interfaces(run: Run, tmp_path: Path) -> None:
    text = PAIR.replace("certh: ,", "cert: {title: CERTH, contact: a@b.example},").replace(
        "owner: certh", "owner: cert"
    )
    diff, agreement = since_head(run, tmp_path / "pair", text, ("cert:", "certh:"), ("owner: cert", "owner: certh"))
    assert "1 change (1 renamed)" in diff
    assert "Nothing between the two has changed since HEAD" in agreement


def test_a_component_in_another_group_is_moved_in_the_agreement_as_in_the_diff(run: Run, tmp_path: Path) -> None:
    text = PAIR.replace("  display:", "  eyes: {owner: certh}\n  display:").replace(
        "owner: certh\n", "owner: certh\n    title: Sensing\n", 1
    )
    camera = next(line for line in text.splitlines() if line.startswith("      camera:"))
    edits = [(camera + "\n", ""), ("eyes: {owner: certh}", f"eyes:\n    owner: certh\n    components:\n{camera}")]
    diff, agreement = since_head(run, tmp_path / "pair", text, *edits)
    assert "1 moved" in diff
    assert "): 1 moved.\n" in agreement


def hide_versions(words: str) -> str:
    return re.sub(r"\b[0-9a-f]{6}\b", "V", words)


@pytest.mark.parametrize(
    ("edits", "verdict"),
    try_some(
        [
            ([], []),
            ([("Colour camera", "Eye")], []),
            (RENAMES, []),
            (
                [("topic: /image", "topic: /rgb")],
                ["  `sensing.camera.image` (version V, V was signed)", "    Topic was signed as /image, and is /rgb"],
            ),
            ([("inputs: {image: camera.image}", "title: S")], ["  `sensing.camera.image` was signed, and is gone"]),
            (
                [
                    ("outputs: {image: Image}", "outputs: {image: Image, more: Image}"),
                    ("camera.image}", "camera.image, more: camera.more}"),
                ],
                ["  `sensing.camera.more` was not signed"],
            ),
        ],
        2,
    ),
)
def test_what_is_not_as_it_was_signed_is_said_and_ends_with_1(
    run: Run, tmp_path: Path, edits: list[tuple[str, str]], verdict: list[str]
) -> None:
    text = PAIR + NODES
    root = repository(tmp_path / "pair", {"archgen.yaml": text})
    git(root, "tag", "signed")
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    (root / "archgen.yaml").write_text(text, encoding="utf-8")
    ran = run("interfaces", root, "--between", "certh", "sssa", "--signed", "signed")
    head = git(root, "rev-parse", "--short=7", "signed")
    said = [f"not as signed at signed ({head}):" if verdict else f"as signed at signed ({head})", *verdict]
    note = ["note: this is about the working tree, which has changes that are not committed"] if edits else []
    assert (ran.status, hide_versions(ran.err).splitlines()) == (1 if verdict else 0, [*note, *said])


def test_a_signed_state_with_errors_cannot_be_judged(run: Run, tmp_path: Path) -> None:
    root = repository(tmp_path / "pair", {"archgen.yaml": PAIR, "more.yaml": "groups: {x: ["})
    git(root, "tag", "signed")
    (root / "more.yaml").unlink()
    ran = run("interfaces", root, "--between", "certh", "sssa", "--signed", "signed")
    assert ran.status == 1
    assert ran.err.startswith("cannot be judged: the architecture cannot be read whole at signed (")
    assert " (more.yaml:1: " in ran.err
    ran = run("interfaces", root, "--between", "certh", "sssa", "--signed", "signed", "--since", "signed")
    assert (ran.status, "give one of them" in ran.err) == (2, True)


def test_what_was_measured_stands_beside_what_is_promised(run: Run, duo: Path, tmp_path: Path) -> None:
    ran = run("interfaces", duo, "--between", "north", "south")
    topic = re.search(r"\*\*Topic:\*\* `([^`]+)`", ran.out)
    assert topic
    (tmp_path / "seen.yaml").write_text(f"measured: {{{topic[1]}: {{rate: 7.5 Hz}}}}\n", encoding="utf-8")
    ran = run("interfaces", duo, "--between", "north", "south", "--measured", tmp_path / "seen.yaml")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.count("Expected, not promised | Measured |") == 1
    assert "| 7.5 Hz" in ran.out


def test_measured_figures_of_what_nobody_knows_are_refused(run: Run, duo: Path, tmp_path: Path) -> None:
    (tmp_path / "seen.yaml").write_text("measured: {nope: {rate: 7.5 Hz}}\n", encoding="utf-8")
    ran = run("interfaces", duo, "--between", "north", "south", "--measured", tmp_path / "seen.yaml")
    assert (ran.status, ran.out) == (1, "")
    assert "no node, activity or topic is called `nope`" in ran.err
    ran = run("interfaces", duo, "--between", "north", "south", "--measured", tmp_path / "none.yaml")
    assert (ran.status, ran.out) == (2, "")
