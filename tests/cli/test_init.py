"""`archgen init`: what it writes, asks and keeps; on a terminal and in a script."""

from __future__ import annotations

import contextlib
import json
import os
import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from archgen.emit import file_tree, new_files
from archgen.pipeline import check_project
from tests import repositories
from tests.cli.conftest import Run
from tests.running import ROOT, contents

FILES = [
    ".gitattributes",
    ".github/workflows/architecture.yml",
    ".github/workflows/open-requests.yml",
    ".gitignore",
    ".vscode/archgen.schema.json",
    ".vscode/extensions.json",
    ".vscode/settings.json",
    "README.md",
    "archgen.yaml",
    "groups/driving.yaml",
    "groups/sensing.yaml",
]


def findings(folder: Path) -> list[str]:
    return [f"{d.rule} {d.span}" for d in check_project(folder).findings]


def test_without_a_terminal_it_asks_nothing_and_checks_clean(run: Run, tmp_path: Path) -> None:
    ran = run("init", tmp_path / "my-Robot")
    assert (ran.status, ran.err) == (0, "")
    assert "My robot: 2 groups, 3 components; archgen check says: no findings." in ran.out
    assert list(contents(tmp_path / "my-Robot")) == FILES
    assert findings(tmp_path / "my-Robot") == []


@pytest.mark.parametrize(
    "words", ["", "--partner a=A --partner b=B --group g=a --group h=b", "--empty", "--distro noetic"]
)
def test_its_files_have_the_one_style(run: Run, tmp_path: Path, words: str) -> None:
    run("init", tmp_path / "robot", *words.split())
    assert run("fmt", "-C", tmp_path / "robot", "--check").status == 0


@pytest.mark.parametrize(
    ("name", "title"), [("my-Robot", None), ("2nd robot", 'A: "b" #c'), ("größer", "yes"), ("機械", "${{ x }} [[ y ]]")]
)
def test_any_name_and_title_checks_clean(name: str, title: str | None, run: Run, tmp_path: Path) -> None:
    folder = tmp_path / name
    assert run("init", folder, *(("--title", title) if title else ())).status == 0
    assert findings(folder) == []
    assert title is None or check_project(folder).architecture.project.title == title


@pytest.mark.parametrize("count", [1, 2, 3, 5])
def test_groups_and_owners_of_ones_own(count: int, run: Run, tmp_path: Path) -> None:
    groups = [word for n in range(count) for word in ("--group", f"Part {n}=b")]
    assert run("init", tmp_path / "r", "--partner", "a=Lab A", "--partner", "B", *groups, "--ci", "none").status == 0
    assert findings(tmp_path / "r") == []
    found = check_project(tmp_path / "r").architecture
    assert [(g.id, g.title, g.owner) for g in found.groups.values()] == [
        (f"part_{n}", f"Part {n}", "b") for n in range(count)
    ]
    assert {name: partner.title for name, partner in found.partners.items()} == {"a": "Lab A", "b": "B"}
    assert len(found.edges) == len(found.components) - 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--map", "Baugruppe=group"), "--map says what the headings of a table mean: it needs --from"),
        (
            ("--from", "x.csv", "--map", "Baugruppe"),
            "'Baugruppe' is no heading with its meaning: write \"Baugruppe=group\"",
        ),
        (
            ("--from", "x.csv", "--map", "A=grop"),
            (
                "'grop' is nothing that a column can mean. did you mean group? Columns mean: kind, group, component, id, title, "
                "functionality, description, owner, role, input, output, from, to, from_group, to_group, signal, type, message, node, "
                "package, topic, rate, period, requirement, status"
            ),
        ),
        (("--partner", "a @-x"), "'@-x' is no handle: write @user, @organisation/team or an e-mail address"),
        (("--partner", "a", "--partner", "A"), "two partners have the id 'a'"),
        (("--group", "g=a"), "'a' is no partner's id (none is named with --partner)"),
        (("--partner", "b", "--group", "g=a"), "'a' is no partner's id (b)"),
        (("--group", "g", "--from", "x.csv"), "--from takes the groups from the table: leave out --group"),
    ],
)
def test_wrong_flags(words: tuple[str, ...], said: str, run: Run, tmp_path: Path) -> None:
    ran = run("init", tmp_path / "r", *words)
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.endswith(f"Error: {said}\n")
    assert not (tmp_path / "r").exists()


@pytest.mark.parametrize(
    ("forge", "existing", "expected"),
    [
        ("github", ".gitlab/CODEOWNERS", "CODEOWNERS"),
        ("gitlab", ".github/CODEOWNERS", "CODEOWNERS"),
        ("github", ".github/CODEOWNERS", ".github/CODEOWNERS"),
        ("gitlab", ".gitlab/CODEOWNERS", ".gitlab/CODEOWNERS"),
        ("none", ".gitlab/CODEOWNERS", ".gitlab/CODEOWNERS"),
    ],
)
def test_a_codeowners_file_of_another_forge_is_none(
    forge: str, existing: str, expected: str, run: Run, tmp_path: Path
) -> None:
    for folder in (".git", existing.partition("/")[0]):
        (tmp_path / folder).mkdir()
    (tmp_path / existing).write_text("theirs\n", encoding="utf-8")
    ran = run("init", tmp_path / "r", "--yes", "--partner", "a=Lab A @lab/a", "--ci", forge)
    assert ran.status == 0, ran.err
    assert (f"kept {tmp_path / expected}" in ran.out) is (existing == expected)
    assert (tmp_path / "CODEOWNERS").exists() is (expected == "CODEOWNERS")
    assert (tmp_path / existing).read_text(encoding="utf-8") == "theirs\n"


def test_codeowners_come_from_the_owners(run: Run, tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    words = ("--partner", "a=Lab A @lab/a", "--partner", "b=Lab B", "--group", "one=a", "--group", "two=b")
    assert run("init", tmp_path / "r", *words).status == 0
    lines = (tmp_path / "CODEOWNERS").read_text(encoding="utf-8").splitlines()
    assert "/r/groups/one.yaml @lab/a" in lines
    assert findings(tmp_path / "r") == []
    ran = run("init", tmp_path / "s", *words)
    assert f"kept {tmp_path / 'CODEOWNERS'}: it is there already" in ran.out
    ran = run("init", tmp_path / "t", "--partner", "a")
    assert "No CODEOWNERS yet: give the partners `reviewers`" in ran.out


def test_a_project_is_never_overwritten(run: Run, first: Path) -> None:
    before = contents(first)
    ran = run("init", first)
    assert ran.status == 2
    assert ran.err == f"Error: {first / 'archgen.yaml'} is there already; nothing was written\n"
    assert contents(first) == before
    assert run("init", first / "archgen.yaml").status == 2


def test_files_that_are_there_are_kept_and_named(run: Run, tmp_path: Path) -> None:
    for name in ("README.md", ".gitignore", "docker.yaml"):
        (tmp_path / name).write_text(f"{name}: mine\n", encoding="utf-8")
    ran = run("init", tmp_path)
    assert ran.status == 0
    assert f"kept {tmp_path / 'README.md'}: it is there already" in ran.out
    assert (tmp_path / "README.md").read_text(encoding="utf-8") == "README.md: mine\n"
    assert (tmp_path / ".gitignore").read_text(encoding="utf-8") == ".gitignore: mine\n"
    assert findings(tmp_path) == [], "other YAML files are not looked at"


def test_a_group_s_file_that_is_there_stops_it(run: Run, tmp_path: Path) -> None:
    (tmp_path / "groups").mkdir()
    (tmp_path / "groups/sensing.yaml").write_text("mine: 1\n", encoding="utf-8")
    ran = run("init", tmp_path)
    assert ran.status == 2
    assert ran.err == f"Error: {tmp_path / 'groups/sensing.yaml'} would have to be replaced; nothing was written\n"
    assert list(contents(tmp_path)) == ["groups/sensing.yaml"]


def test_in_a_repository_the_workflow_goes_to_its_top(run: Run, tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    ran = run("init", tmp_path / "robots/one")
    assert f"The repository begins at {tmp_path}: what the forge reads stands there." in ran.out
    workflow = yaml.safe_load((tmp_path / ".github/workflows/architecture.yml").read_bytes())
    assert workflow["jobs"]["check"]["steps"][1]["with"] == {"project": "robots/one"}
    assert workflow[True]["pull_request"] == {"paths": ["robots/one/**", "**/*.yaml", "**/*.yml"]}
    assert not (tmp_path / "robots/one/.github").exists()


def test_a_second_project_of_a_repository_has_a_workflow_of_its_own(run: Run, tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    for name in ("alpha", "beta"):
        assert run("init", tmp_path / "robots" / name, "--yes").status == 0
    workflows = {file.name: yaml.safe_load(file.read_bytes()) for file in (tmp_path / ".github/workflows").iterdir()}
    assert {
        name: (workflow["jobs"]["check"]["steps"][1]["with"]["project"], "publish" in workflow["jobs"])
        for name, workflow in workflows.items()
    } == {
        "architecture.yml": ("robots/alpha", True),
        "architecture-robots-beta.yml": ("robots/beta", False),
        "open-requests.yml": ("robots/alpha", False),
        "open-requests-robots-beta.yml": ("robots/beta", False),
    }


def test_a_pipeline_that_is_there_does_not_check_the_new_project(run: Run, tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    run("init", tmp_path / "alpha", "--yes", "--ci", "gitlab")
    ran = run("init", tmp_path / "beta", "--yes", "--ci", "gitlab")
    assert (
        "That .gitlab-ci.yml does not check this project yet: docs/pull_requests.md says which job to add." in ran.out
    )


def test_a_folder_with_strange_letters_is_quoted_in_the_workflow(run: Run, tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    assert run("init", tmp_path / "a: ${{ b }} *").status == 0
    workflow = yaml.safe_load((tmp_path / ".github/workflows/architecture.yml").read_bytes())
    assert workflow["jobs"]["check"]["steps"][1]["with"]["project"] == "a: ${{ '${{' }} b }} *"
    assert workflow[True]["pull_request"] is None


def test_the_workflow_names_inputs_that_the_action_has(run: Run, tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    run("init", tmp_path / "r")
    steps = yaml.safe_load((tmp_path / ".github/workflows/architecture.yml").read_bytes())["jobs"]
    inputs = yaml.safe_load((ROOT / "action.yml").read_bytes())["inputs"]
    assert steps["check"]["steps"][1]["uses"] == "archgen/archgen@v0"
    assert set(steps["check"]["steps"][1]["with"]) <= set(inputs)
    assert (
        ROOT / steps["comment"]["steps"][0]["uses"].split("@")[0].removeprefix("archgen/archgen/") / "action.yml"
    ).exists()


def test_gitlab(run: Run, tmp_path: Path) -> None:
    assert run("init", tmp_path, "--ci", "gitlab").status == 0
    made = yaml.safe_load((tmp_path / ".gitlab-ci.yml").read_bytes())
    assert made["variables"] == {"ARCHGEN_PROJECT": "."}
    assert (ROOT / made["include"][0]["remote"].partition("/v0/")[2]).exists()
    assert not (tmp_path / ".github").exists()


def test_settings_are_what_editors_and_git_read(run: Run, tmp_path: Path) -> None:
    run("init", tmp_path)
    settings = json.loads((tmp_path / ".vscode/settings.json").read_bytes())
    (schema,) = settings["yaml.schemas"]
    assert json.loads((tmp_path / schema).read_bytes())["$id"] == "urn:archgen:schema:1"
    for file in ("archgen.yaml", "groups/sensing.yaml"):
        line = (tmp_path / file).read_text(encoding="utf-8").splitlines()[0]
        assert line.startswith("# yaml-language-server: $schema=")
        assert ((tmp_path / file).parent / line.partition("=")[2]).resolve() == (tmp_path / schema).resolve()
    assert schema.removeprefix("./") in (tmp_path / ".gitignore").read_text(encoding="utf-8").splitlines()
    attributes = (tmp_path / ".gitattributes").read_text(encoding="utf-8")
    assert not any(word in attributes for word in ("filter", "diff=", "merge="))


def test_where_nothing_can_be_written(run: Run, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    ran = run("init", tmp_path / "file" / "below")
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.startswith("Error: cannot write ")
    assert "mistake in archgen" not in ran.err


def test_a_link_that_leads_out_is_not_followed(run: Run, tmp_path: Path) -> None:
    (tmp_path / "r").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "r/.vscode").symlink_to(tmp_path / "elsewhere")
    ran = run("init", tmp_path / "r")
    assert ran.status == 2
    assert "is a link that leads out of" in ran.err
    assert contents(tmp_path / "elsewhere") == {}
    assert [path.name for path in (tmp_path / "r").iterdir()] == [".vscode"]


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_a_failure_half_way_leaves_nothing(
    error: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "r" / "b").mkdir(parents=True)
    placed: list[Path] = []
    place = new_files._place_file  # noqa: SLF001 - the failing disk stands in its place

    def failing(staged: Path, path: Path) -> None:
        if len(placed) == 2:
            raise error
        placed.append(path)
        place(staged, path)

    monkeypatch.setattr(new_files, "_place_file", failing)
    files = {tmp_path / "r" / name: b"x" for name in ("a", "b/c", "b/d", "e/f")}
    with pytest.raises(file_tree.OutputError if isinstance(error, OSError) else KeyboardInterrupt):
        new_files.write_new_files(files, tmp_path / "r")
    assert len(placed) == 2
    assert [path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*")] == ["r", "r/b"]


@pytest.mark.parametrize("steps", range(5))
@pytest.mark.parametrize("exists", [False, True])
def test_a_run_that_is_killed_leaves_no_half_project(
    steps: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, exists: bool
) -> None:
    """Killed after so many moves, without a chance to take anything back; the next run ends what this one began."""
    top = tmp_path / "r"
    if exists:
        top.mkdir()
    files = {top / name: name.encode() for name in ("archgen.yaml", ".gitattributes", "groups/a.yaml", ".github/b.yml")}
    moves: list[object] = []

    def move_or_die(*words: Any) -> None:  # noqa: ANN401 - whatever is moved
        if len(moves) == steps:
            raise SystemError
        moves.append(words)
        move(*words)

    move = os.rename
    with monkeypatch.context() as patch:
        patch.setattr(new_files, "_undo_creation", lambda _: None)
        patch.setattr(os, "link", move_or_die)
        patch.setattr(Path, "rename", move_or_die)
        with contextlib.suppress(SystemError):
            new_files.write_new_files(files, top)
    there = {path for path in files if path.exists()}
    assert top / "archgen.yaml" not in there or there == set(files)
    if there != set(files):
        new_files.write_new_files(files, top)
    assert {path: path.read_bytes() for path in top.rglob("*") if path.is_file()} == files


def test_what_appears_meanwhile_is_not_replaced(tmp_path: Path) -> None:
    (tmp_path / "b").write_text("mine", encoding="utf-8")
    with pytest.raises(file_tree.OutputError, match="File exists"):
        new_files.write_new_files({tmp_path / "a": b"1", tmp_path / "b": b"2"}, tmp_path)
    assert contents(tmp_path) == {"b": b"mine"}


def test_a_table_in_a_partners_language_says_what_became_of_it(run: Run, tmp_path: Path) -> None:
    table = tmp_path / "teile.csv"
    table.write_text("Hauptgruppe;Komponente;Preis\nAntrieb;Rad;3 EUR\nSumme:;1;3 EUR\n", encoding="utf-8")
    ran = run("init", tmp_path / "My Robot Ä", "--yes", "--from", table, "--map", "Hauptgruppe=group")
    assert ran.status == 0, ran.err
    assert ran.out.splitlines()[:6] == [
        f"{table}: 6 cells below headings: 2 taken, 4 not taken",
        '  headings: Hauptgruppe = group, Komponente = component, Preis is not taken (--map "Preis=MEANING")',
        "  not taken: 2:13 `3 EUR`: its column `Preis` was not taken",
        "  not taken: 3:8 `1`: it stands in a row of totals",
        "  not taken: 3:10 `3 EUR`: it stands in a row of totals",
        "",
    ]
    assert "My Robot Ä: 1 group, 1 component; archgen check says: 1 warning, 1 note." in ran.out
    assert "By rule: 1 missing-detail, 1 unmapped-component." in ran.out
    assert "`Summe:` begins a row of totals, which was not taken" in ran.err
    assert "1 components" not in ran.err + ran.out


def test_a_title_is_kept_as_it_is_typed(run: Run, tmp_path: Path) -> None:
    assert (
        run("init", tmp_path / "My Robot ÄÖ", "--partner", "robo corp = RoboCorp", "--group", "g=robo corp").status == 0
    )
    found = check_project(tmp_path / "My Robot ÄÖ").architecture
    assert (found.project.id, found.project.title) == ("my_robot_aeoe", "My Robot ÄÖ")
    assert {name: partner.title for name, partner in found.partners.items()} == {"robo_corp": "RoboCorp"}
    assert found.groups["g"].owner == "robo_corp"


def test_a_second_project_says_that_code_owners_lack_its_files(run: Run, tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    words = ("--partner", "eye=Eye @eye/x", "--yes")
    first, second = (run("init", tmp_path / name, *words) for name in ("one", "two"))
    hint = (
        "That CODEOWNERS does not name this project's files yet: add what `archgen owners --format codeowners` prints."
    )
    assert (hint in first.out, hint in second.out) == (False, True)


def test_each_partner_gets_a_file_for_its_agreements_that_codeowners_gives_to_it(run: Run, tmp_path: Path) -> None:
    (tmp_path / "params.yaml").write_text("speed: 1\n")
    ran = run("init", tmp_path, "--partner", "eye=Eye Lab @eye/x", "--partner", "arm=Arm @arm/y", "--yes")
    assert (ran.status, "archgen check says: no findings." in ran.out) == (0, True)
    assert "sources:" in (tmp_path / "archgen.yaml").read_text()
    assert findings(tmp_path) == []
    for name in ("eye", "arm"):
        with (tmp_path / f"review/{name}.yaml").open("a", encoding="utf-8") as stream:
            stream.write("    sensing.camera: {key: removed, reason: agreed}\n")
    assert {entry.partner for entry in check_project(tmp_path).architecture.review.accepted} == {"eye", "arm"}
    owners = (tmp_path / "CODEOWNERS").read_text(encoding="utf-8").splitlines()
    assert {"/archgen.yaml @eye/x @arm/y", "/review/arm.yaml @arm/y", "/review/eye.yaml @eye/x"} <= set(owners)


@pytest.mark.parametrize(("reviewers", "severity"), [("@eva", "error"), ("@eye/x", "warning"), ("", "warning")])
def test_a_new_project_has_a_gate(run: Run, tmp_path: Path, reviewers: str, severity: str) -> None:
    partners = ("--partner", f"eye=Eye Lab {reviewers}", "--partner", "arm=Arm @ann")
    assert run("init", tmp_path, *partners, "--group", "see=eye", "--group", "act=arm", "--yes").status == 0
    assert findings(tmp_path) == []
    policy = str(check_project(tmp_path).architecture.review.breaking)
    assert policy.startswith(f"{{wire: error, promise: error, meaning: warning, source: note, foreign: {severity}")
    assert "breaking" not in re.sub("(?m)^#.*", "", fill_alone(run, tmp_path / "alone"))


def fill_alone(run: Run, folder: Path) -> str:
    """Make the project of one who works alone, and give its first file."""
    assert run("init", folder, "--yes").status == 0
    return (folder / "archgen.yaml").read_text(encoding="utf-8")


def test_what_init_writes_is_the_gate_of_the_workflow(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    repositories.repository(tmp_path)
    partners = (
        "--partner",
        "eye=Eye Lab @eva",
        "--partner",
        "arm=Arm @ann",
        "--group",
        "see=eye",
        "--group",
        "act=arm",
    )
    assert run("init", tmp_path, *partners, "--ci", "github", "--yes").status == 0
    repositories.commit(tmp_path, {})
    repositories.git(tmp_path, "checkout", "-q", "-b", "work")
    text = (tmp_path / "groups/act.yaml").read_text(encoding="utf-8")
    repositories.commit(tmp_path, {"groups/act.yaml": text.replace("role: filter", "role: reactive", 1)})
    monkeypatch.setenv("GITHUB_ACTOR", "eva")
    ran = run("review", tmp_path, "--base", "main", "--no-build")
    assert (ran.status, "breaks Arm (foreign)" in ran.out) == (1, True)
    monkeypatch.setenv("GITHUB_ACTOR", "ann")
    assert run("review", tmp_path, "--base", "main", "--no-build").status == 0
    # A file more: CODEOWNERS does not name it.
    repositories.commit(tmp_path, {"groups/more.yaml": "hosts: {pc: PC}\n"})
    assert "stale-codeowners" in run("check", tmp_path).out


def test_an_empty_project_has_the_groups_that_are_named_and_takes_components(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "robot"
    words = ("--empty", "--partner", "kth=KTH", "--group", "perception=kth")
    assert run("init", folder, *words).status == 0
    assert findings(folder) == []
    architecture = check_project(folder).architecture
    assert (list(architecture.groups), list(architecture.components), architecture.requirements) == (
        ["perception"],
        [],
        {},
    )
    assert run("new", "component", "perception.camera", "-C", folder).status == 0
    assert list(check_project(folder).architecture.components) == ["perception.camera"]
    assert run("init", tmp_path / "other", "--empty").status == 0
    assert run("new", "group", "navigation", "-C", tmp_path / "other").status == 0
    assert list(check_project(tmp_path / "other").architecture.groups) == ["navigation"]


@pytest.mark.parametrize("forge", ["github", "gitlab"])
def test_a_workflow_that_finds_no_archgen_yet_is_said(forge: str, run: Run, tmp_path: Path) -> None:
    ran = run("init", tmp_path / "robot", "--ci", forge)
    assert "where it is not published yet" in ran.out
    assert "Until archgen is published" in (tmp_path / "robot/README.md").read_text()
    assert "not published" not in run("init", tmp_path / "other", "--ci", "none").out
