"""The workflow files: zizmor has nothing to say, and the commands in them do what they promise."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from archgen.resources import REPOSITORY
from tests import repositories
from tests.outside_tools import run_judge
from tests.property_sizes import try_some
from tests.running import ROOT

FILES = (
    "action.yml",
    "comment/action.yml",
    ".github/workflows/ci.yml",
    ".github/workflows/action.yml",
    ".github/workflows/supply.yml",
    ".github/workflows/release.yml",
    ".github/workflows/pages.yml",
)
ROBOT = """\
archgen: 1
partners: {p: {title: P}, q: {title: Q}}
groups:
  sensing: {owner: p, components: {camera: {functionality: Sees., outputs: {image: sensor_msgs/msg/Image}}}}
  acting: {owner: q, components: {arm: {functionality: Grasps., inputs: {image: camera.image}}}}
nodes: {camera: {implements: camera}, arm: {implements: arm}}
"""


def read(name: str) -> dict[str, Any]:
    data: dict[str, Any] = yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))
    return data


def test_zizmor_finds_nothing() -> None:
    program = Path(sys.executable).with_name("zizmor")
    done = run_judge(program, "--offline", "--no-progress", "--no-config", "--strict-collection", *FILES, cwd=ROOT)
    assert "No findings to report" in done.stdout + done.stderr


def test_every_foreign_action_is_pinned_by_its_hash() -> None:
    used = [word for name in FILES for word in re.findall(r"uses: (\S+)", (ROOT / name).read_text(encoding="utf-8"))]
    assert used
    assert [
        word for word in used if not word.startswith((".", "$/")) and not re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", word)
    ] == []


def test_no_value_of_an_event_is_put_into_a_shell_command() -> None:
    for name in ("action.yml", "comment/action.yml"):
        for step in read(name)["runs"]["steps"]:
            assert "${{" not in step.get("run", "")


def run(step: dict[str, Any], folder: Path, runner: Path, **environment: str) -> dict[str, str]:
    """Run a step of an action as a runner does; give the outputs that it sets."""
    out = runner / "github_output"
    out.write_text("")
    done = subprocess.run(  # noqa: S603 - what stands in our own file
        ["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]],  # noqa: S607 - as a runner starts it
        cwd=folder,
        env={
            **os.environ,
            "RUNNER_TEMP": str(runner),
            "GITHUB_OUTPUT": str(out),
            "GITHUB_ACTIONS": "true",
            **environment,
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (runner / "said").write_text(done.stdout)
    return dict(line.split("=", 1) for line in out.read_text().splitlines())


@pytest.fixture
def runner(tmp_path: Path) -> Path:
    """Make the folder of a runner in which archgen is installed."""
    programs = tmp_path / "runner/archgen/bin"
    programs.mkdir(parents=True)
    script = f'#!/bin/sh\nPYTHONPATH="{ROOT}" exec "{sys.executable}" -m archgen "$@"\n'
    (programs / "archgen").write_text(script)
    (programs / "archgen").chmod(0o755)
    return tmp_path / "runner"


def defaults(step: dict[str, Any], **given: str) -> dict[str, str]:
    """Give a step's environment with the inputs' defaults, as GitHub fills it in."""
    inputs = {name: str(value.get("default", "")) for name, value in read("action.yml")["inputs"].items()} | given
    return {key: inputs[re.fullmatch(r"\$\{\{ inputs\.(\w+) \}\}", value)[1]] for key, value in step["env"].items()}  # type: ignore[index]


def test_what_the_cache_keeps_is_named_by_what_is_installed(tmp_path: Path, runner: Path) -> None:
    steps = read("action.yml")["runs"]["steps"]
    (version,) = (step for step in steps if step.get("id") == "version")
    source = tmp_path / "source"
    (source / ".git").mkdir(parents=True)
    (source / "a b.py").write_text("1\n")
    names = []
    for file, text in ((".git/HEAD", "x"), (".git/HEAD", "y"), ("a b.py", "2\n"), ("c.py", "2\n")):
        (source / file).write_text(text)
        names.append(run(version, tmp_path, runner, GITHUB_ACTION_PATH=str(source))["digest"])
    assert names[0] == names[1]
    assert len({*names}) == 3
    # Kept before anything of a branch is read, and only where it was made anew.
    order = [step.get("uses", step.get("name", "")).split("@")[0] for step in steps]
    save = order.index("actions/cache/save")
    assert order.index("actions/cache/restore") < order.index("Install archgen") < save < order.index("Review")
    (restore,) = (step for step in steps if step.get("id") == "cache")
    assert "steps.python.outputs.python-version" in restore["with"]["key"]
    assert steps[save]["with"]["path"] == restore["with"]["path"]


def test_the_action_reviews_a_pull_request(tmp_path: Path, runner: Path) -> None:
    folder = repositories.repository(tmp_path / "work", {"robot/archgen.yaml": ROBOT})
    repositories.git(folder, "checkout", "-q", "-b", "stranger")
    repositories.commit(
        folder, {"robot/archgen.yaml": ROBOT.replace("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")}
    )
    step = next(one for one in read("action.yml")["runs"]["steps"] if one.get("id") == "review")
    summary = runner / "summary.md"
    given = defaults(step, project="robot", base="main", build="false")
    told = run(step, folder, runner, **given, GITHUB_STEP_SUMMARY=str(summary), GITHUB_WORKSPACE=str(folder))
    assert told == {"status": "0"}
    made = folder / given["ARCHGEN_OUTPUT"]
    assert {file.name for file in made.iterdir()} == {
        *("findings.sarif", "findings.xml", "comment.md", "diff.json", "diff.html"),
    }
    assert "CompressedImage" in (made / "comment.md").read_text(encoding="utf-8")
    assert summary.read_text(encoding="utf-8") == (made / "comment.md").read_text(encoding="utf-8")
    assert "file=robot/archgen.yaml" in (runner / "said").read_text()


def test_the_action_fails_with_errors_after_it_has_made_everything(tmp_path: Path, runner: Path) -> None:
    folder = repositories.repository(tmp_path / "work", {"archgen.yaml": ROBOT.replace("camera.image", "camera.imgae")})
    step = next(one for one in read("action.yml")["runs"]["steps"] if one.get("id") == "review")
    given = defaults(step, build="false") | {"ARCHGEN_BASE": ""}
    told = run(step, folder, runner, **given, GITHUB_WORKSPACE=str(folder))
    assert told == {"status": "1"}
    assert (folder / given["ARCHGEN_OUTPUT"] / "findings.sarif").exists()
    assert "::error" in (runner / "said").read_text()


def run_hook(hook: dict[str, Any], folder: Path, runner: Path) -> subprocess.CompletedProcess[str]:
    """Run a hook as pre-commit does: its words, without a shell, at the repository's top."""
    program, *words = hook["entry"].split()
    return subprocess.run(  # noqa: S603 - what stands in our own file
        [runner / "archgen/bin" / program, *words], cwd=folder, capture_output=True, text=True, check=False
    )


def test_the_hook_of_pre_commit_shows_only_what_stops_the_commit(tmp_path: Path, runner: Path) -> None:
    hook, *_ = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
    assert (hook["language"], hook["stages"], hook["pass_filenames"]) == ("python", ["pre-commit"], False)
    assert re.search(hook["files"], "groups/sensing.yaml")
    assert not re.search(hook["files"], "firmware/main.c")
    unserved = f"{ROBOT}requirements: {{R-1: It works}}\n"
    text = f"{unserved}rules: {{uncovered-requirement: error}}\n"
    folder = repositories.repository(tmp_path / "work", {"archgen.yaml": text})
    done = run_hook(hook, folder, runner)
    assert done.returncode == 1
    assert [line for line in done.stdout.splitlines() if re.match(r"(error|warning|note)\[", line)] == [
        "error[uncovered-requirement]: no component and no chain serves the requirement"
    ]
    assert done.stderr == "not shown: 2 warnings, 2 notes\n"
    (folder / "archgen.yaml").write_text(unserved)
    done = run_hook(hook, folder, runner)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_the_hook_for_one_style_lays_the_files_out(tmp_path: Path, runner: Path) -> None:
    _, hook, _ = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
    folder = repositories.repository(tmp_path / "work", {"archgen.yaml": "archgen: 1\ngroups:\n    a: {title: A}\n"})
    assert (run_hook(hook, folder, runner).returncode, hook["pass_filenames"]) == (0, False)
    assert (folder / "archgen.yaml").read_text() == "archgen: 1\ngroups:\n  a: {title: A}\n"


@pytest.mark.slow
def test_the_hook_before_a_push_holds_it_against_the_main_line_of_the_remote(tmp_path: Path, runner: Path) -> None:
    *_, hook = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8"))
    assert (hook["stages"], hook["always_run"], hook["pass_filenames"]) == (["pre-push"], True, False)
    strict = f"{ROBOT}review: {{breaking: error}}\n"
    folder = repositories.repository(tmp_path / "work", {"README.md": "x\n"})
    done = run_hook(hook, folder, runner)
    assert (done.returncode, "knows no main line of `origin`" in done.stderr) == (0, True)
    repositories.git(tmp_path, "clone", "-q", "--bare", str(folder), "remote.git")
    repositories.git(folder, "remote", "add", "origin", "../remote.git")
    repositories.git(folder, "fetch", "-q")
    repositories.commit(folder, {"archgen.yaml": strict})
    done = run_hook(hook, folder, runner)
    assert (done.returncode, "`origin` is without this project" in done.stderr) == (0, True)
    repositories.git(folder, "push", "-q", "origin", "main")
    # Also on the main line itself, and of what is committed, whatever lies in the working tree.
    repositories.commit(
        folder, {"archgen.yaml": strict.replace("outputs: {image: sensor_msgs/msg/Image}", "outputs: {}")}
    )
    (folder / "archgen.yaml").write_text(strict)
    done = run_hook(hook, folder, runner)
    assert (done.returncode, "breaks Q (wire)" in done.stdout) == (1, True)


def test_gitlab_runs_the_same_commands(tmp_path: Path, runner: Path) -> None:
    template = read("ci/gitlab.yml")
    folder = repositories.repository(tmp_path / "work", {"archgen.yaml": ROBOT})
    script = "\n".join(template["archgen"]["script"])
    environment = {key: str(value) for key, value in template["variables"].items()}
    path = f"{runner}/archgen/bin:{os.environ['PATH']}"
    base = repositories.git(folder, "rev-parse", "HEAD")
    done = subprocess.run(  # noqa: S603 - what stands in our own file
        ["bash", "-eo", "pipefail", "-c", script],  # noqa: S607 - as GitLab starts it
        cwd=folder,
        env={
            **os.environ,
            **environment,
            "PATH": path,
            "ARCHGEN_BASE": base,
            "ARCHGEN_BUILD": "false",
            "GITHUB_ACTIONS": "",
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    wanted = template["archgen"]["artifacts"]["reports"]["junit"]
    assert (folder / wanted).exists()


def merge_branches(folder: Path) -> tuple[str, str]:
    """Make a robot whose main line and branch changed different things, check out their merge; return fork and tip."""
    repositories.repository(folder, {"archgen.yaml": ROBOT, "README.md": "x\n"})
    fork = repositories.git(folder, "rev-parse", "HEAD")
    repositories.git(folder, "checkout", "-q", "-b", "work")
    repositories.commit(folder, {"archgen.yaml": ROBOT.replace("Grasps.", "Grasps and holds.")})
    tip = repositories.git(folder, "rev-parse", "HEAD")
    repositories.git(folder, "checkout", "-q", "main")
    repositories.commit(folder, {"more.yaml": "requirements: {R-1: It works}\n"})
    repositories.git(folder, "checkout", "-q", "--detach")
    repositories.git(folder, "merge", "-q", "--no-ff", "-m", "x", "work")
    return fork, tip


@pytest.mark.parametrize("kind", try_some(["merged_result", "merge_train"]))
def test_a_merged_results_pipeline_of_gitlab_tells_only_what_the_request_changes(
    tmp_path: Path, runner: Path, kind: str
) -> None:
    template = read("ci/gitlab.yml")
    folder = tmp_path / "work"
    fork, tip = merge_branches(folder)
    done = subprocess.run(  # noqa: S603 - what stands in our own file
        ["bash", "-eo", "pipefail", "-c", "\n".join(template["archgen"]["script"])],  # noqa: S607 - as GitLab starts it
        cwd=folder,
        env={
            **os.environ,
            **{key: str(value) for key, value in template["variables"].items()},
            "PATH": f"{runner}/archgen/bin:{os.environ['PATH']}",
            "ARCHGEN_BASE": fork,
            "ARCHGEN_BUILD": "false",
            "GITHUB_ACTIONS": "",
            "CI_MERGE_REQUEST_IID": "3",
            "CI_MERGE_REQUEST_EVENT_TYPE": kind,
            "CI_MERGE_REQUEST_TARGET_BRANCH_NAME": "main",
            "CI_MERGE_REQUEST_SOURCE_BRANCH_SHA": tip,
            "CI_COMMIT_SHA": repositories.git(folder, "rev-parse", "HEAD"),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    comment = (folder / "archgen-out/review/comment.md").read_text(encoding="utf-8")
    main = repositories.git(folder, "rev-parse", "--short=7", "main")
    assert f"`main ({main})` → `this merge request ({tip[:7]})`" in comment
    assert "R-1" not in comment
    assert "functionality" in comment


def test_the_action_reviews_what_waits_in_a_merge_queue(tmp_path: Path, runner: Path) -> None:
    folder = tmp_path / "work"
    merge_branches(folder)
    base = repositories.git(folder, "rev-parse", "main")
    step = next(one for one in read("action.yml")["runs"]["steps"] if one.get("id") == "review")
    event = runner / "event.json"
    event.write_text(f'{{"merge_group": {{"base_ref": "refs/heads/main", "base_sha": "{base}"}}}}')
    told = run(
        step,
        folder,
        runner,
        **defaults(step, base=base, build="false"),
        GITHUB_WORKSPACE=str(folder),
        GITHUB_EVENT_NAME="merge_group",
        GITHUB_EVENT_PATH=str(event),
        GITHUB_REF="refs/heads/gh-readonly-queue/main/pr-7-x",
    )
    assert told == {"status": "0"}
    comment = (folder / "archgen-out/review/comment.md").read_text(encoding="utf-8")
    head = repositories.git(folder, "rev-parse", "--short=7", "HEAD")
    assert f"`main ({base[:7]})` → `the merge queue ({head})`" in comment
    assert "R-1" not in comment


def test_the_action_leaves_a_comment_where_the_change_cannot_be_judged(tmp_path: Path, runner: Path) -> None:
    folder = repositories.repository(tmp_path / "work", {"archgen.yaml": ROBOT})
    step = next(one for one in read("action.yml")["runs"]["steps"] if one.get("id") == "review")
    given = defaults(step, base="0" * 40, build="false")
    assert run(step, folder, runner, **given, GITHUB_WORKSPACE=str(folder)) == {"status": "2"}
    made = {file.name for file in (folder / given["ARCHGEN_OUTPUT"]).iterdir()}
    assert made == {"findings.sarif", "findings.xml", "comment.md"}


def test_every_job_of_a_workflow_may_have_an_artifact_of_its_own() -> None:
    steps = read("action.yml")["runs"]["steps"]
    (upload,) = (step for step in steps if "upload-artifact" in step.get("uses", ""))
    (download,) = (step for step in read("comment/action.yml")["runs"]["steps"] if "download" in step.get("uses", ""))
    assert upload["with"]["name"] == download["with"]["name"] == "${{ inputs.artifact }}"
    assert [read(name)["inputs"]["artifact"]["default"] for name in ("action.yml", "comment/action.yml")] == [
        "archgen",
        "archgen",
    ]


def test_the_examples_of_the_manual_name_inputs_and_variables_that_exist() -> None:
    manual = (ROOT / "docs/pull_requests.md").read_text(encoding="utf-8")
    examples = [yaml.safe_load(text) for text in re.findall(r"```yaml\n(.*?)```", manual, re.DOTALL)]
    jobs = [job for example in examples if "jobs" in example for job in example["jobs"].values()]
    steps = [step for job in jobs for step in job["steps"] if step.get("uses", "").startswith(REPOSITORY)]
    assert len(steps) == 7, (
        "a review and a comment twice, the comment after the review of a fork, and both for open requests"
    )
    for step in steps:
        action = read("comment/action.yml" if "/comment@" in step["uses"] else "action.yml")
        assert step.get("with", {}).keys() <= action["inputs"].keys()
    (extended,) = (example for example in examples if "archgen_arm" in example)
    assert extended["archgen_arm"]["extends"] in read("ci/gitlab.yml")
    assert extended["archgen_arm"]["variables"].keys() <= read("ci/gitlab.yml")["variables"].keys()


WORDS_FOR_USERS = (
    "README.md",
    "docs",
    "start",
    "ci",
    "action.yml",
    "comment",
    ".pre-commit-hooks.yaml",
    ".github",
    "archgen",
)


def texts_for_users() -> Iterator[tuple[str, str]]:
    """Give path and text of everything that tells people or servers where archgen is."""
    for name in WORDS_FOR_USERS:
        place = ROOT / name
        for file in sorted(place.rglob("*")) if place.is_dir() else [place]:
            if file.suffix in {".md", ".yml", ".yaml", ".j2", ".py"}:
                yield file.relative_to(ROOT).as_posix(), file.read_text(encoding="utf-8")


def test_nobody_is_told_to_install_archgen_from_the_package_index_where_it_is_not() -> None:
    from_index = re.compile(r"pip install (--\S+ )*archgen\b|ARCHGEN_PACKAGE: archgen\b")
    assert [path for path, text in texts_for_users() if from_index.search(text)] == []


def test_every_address_of_archgen_is_the_one_that_the_code_base_names() -> None:
    address = re.compile(r"(?:github\.com/|githubusercontent\.com/|uses: )([\w.-]+/archgen)\b")
    own_name = re.compile(rf"(?<![\w.]){REPOSITORY}(?![\w.])")
    named = {(path, found) for path, text in texts_for_users() for found in address.findall(text)}
    assert named
    assert [(path, found) for path, found in sorted(named) if found != REPOSITORY] == []
    written = {
        path for path, text in texts_for_users() if path.startswith(("archgen/", "start/")) and own_name.search(text)
    }
    assert written == {"archgen/resources.py"}
