"""What CI and the actions install: locked versions with hashes that pyproject.toml allows, and no token beside."""

from __future__ import annotations

import re
import tomllib
from typing import Any

import pytest
import yaml

from tests.running import ROOT

WORKFLOWS = tuple(f".github/workflows/{name}.yml" for name in ("ci", "action", "supply", "release", "pages"))
LOCKS = ("run.txt", "check.txt", "supply.txt", "fuzz.txt", "docs.txt")


def read_lock(name: str) -> dict[str, tuple[str, list[str]]]:
    """Read the packages of a lock: version and hashes by name."""
    text = (ROOT / "ci/locked" / name).read_text(encoding="utf-8")
    entries = re.findall(
        r"^([a-z0-9.-]+)==(\S+?)(?: ; [^\\\n]+)? \\\n((?: +--hash=\S+(?: \\)?\n)+)", text, re.MULTILINE
    )
    assert re.sub(r"^\S.*\n(?: +--hash=\S+(?: \\)?\n)+", "", text, flags=re.MULTILINE) == ""
    return {package: (version, re.findall(r"--hash=(\S+)", hashes)) for package, version, hashes in entries}


def list_wanted(group: str) -> list[str]:
    data = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    wanted: list[str] = []
    for entry in data["dependency-groups"][group]:
        wanted += [entry] if isinstance(entry, str) else list_wanted(entry["include-group"])
    return wanted


def satisfies(version: str, words: str) -> bool:
    numbers = [int(part) for part in re.findall(r"\d+", version)]
    for operator, bound in re.findall(r"(>=|==)([0-9.]+)", words):
        limit = [int(part) for part in bound.split(".")]
        if (operator == ">=" and numbers < limit) or (operator == "==" and numbers != limit):
            return False
    return True


@pytest.mark.parametrize(
    ("lock", "groups"),
    [
        ("run.txt", ["build"]),
        ("check.txt", ["build", "check"]),
        ("supply.txt", ["supply"]),
        ("fuzz.txt", ["fuzz"]),
        ("docs.txt", ["docs"]),
    ],
)
def test_locked_is_what_is_asked_for(lock: str, groups: list[str]) -> None:
    locked = read_lock(lock)
    wanted = [words for group in groups for words in list_wanted(group)]
    if lock not in {"supply.txt", "fuzz.txt", "docs.txt"}:
        data = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
        wanted += data["project"]["dependencies"]
    for words in wanted:
        name = re.sub(r"[-_.]+", "-", re.split(r"[<>=;\[ ]", words)[0].lower())
        assert name in locked, f"`make lock`: {words} is not locked"
        assert satisfies(locked[name][0], words), f"`make lock`: {words}, locked is {locked[name][0]}"


@pytest.mark.parametrize("lock", LOCKS)
def test_each_locked_file_is_known_by_its_hash(lock: str) -> None:
    locked = read_lock(lock)
    assert locked
    assert all(
        hashes and all(re.fullmatch(r"sha256:[0-9a-f]{64}", one) for one in hashes) for _, hashes in locked.values()
    )
    assert "://" not in (ROOT / "ci/locked" / lock).read_text(encoding="utf-8")  # from whatever index one has


def test_a_checkout_can_be_installed_from_what_is_locked() -> None:
    # Without an isolated build nothing else brings it.
    assert "editables" in read_lock("check.txt")


def test_the_locks_agree() -> None:
    run, check = read_lock("run.txt"), read_lock("check.txt")
    assert {name: check.get(name) for name in run} == run


def list_steps(name: str) -> list[dict[str, Any]]:
    data = yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))
    return [step for job in data.get("jobs", {"": data.get("runs", {})}).values() for step in job.get("steps", [])]


@pytest.mark.parametrize("name", ["action.yml", "comment/action.yml"])
def test_actions_install_what_is_locked_without_a_token(name: str) -> None:
    installing = [step for step in list_steps(name) if "pip install" in step.get("run", "")]
    assert len(installing) == 1
    (step,) = installing
    lines = [line for line in step["run"].splitlines() if "pip install" in line]
    assert [("-r" in line, "--no-index" in line) for line in lines] == [(True, False), (False, True)]
    assert "--require-hashes --only-binary :all:" in step["run"]
    assert "env" not in step
    with_token = [
        one for one in list_steps(name) if any("token" in str(value).lower() for value in one.get("env", {}).values())
    ]
    assert all("install" not in one["run"] for one in with_token)


def test_gitlab_installs_what_is_locked_without_a_token() -> None:
    script = yaml.safe_load((ROOT / "ci/gitlab.yml").read_text(encoding="utf-8"))[".archgen"]["before_script"]
    installing = [line for line in script if "$pip" in line]
    assert len(installing) == 2
    assert "--require-hashes" in installing[0]
    assert "--no-deps --no-build-isolation" in installing[1]
    (pip,) = [line for line in script if line.startswith("pip=")]
    assert "-u ARCHGEN_TOKEN" in pip


def test_our_own_ci_installs_what_is_locked() -> None:
    data = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8"))
    assert data["env"] == {"LOCKED": "1"}
    installs = [
        line
        for line in (ROOT / "Makefile").read_text(encoding="utf-8").splitlines()
        if "pip" in line and " install" in line
    ]
    assert installs
    # What stands without hashes stands where LOCKED is not given, or installs nothing but archgen itself.
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    locked = re.sub(r"^ifndef LOCKED\n(?:.*\n)*?endif\n", "", text, flags=re.MULTILINE)
    locked = re.sub(r"^else\n(?:.*\n)*?endif\n", "", locked, flags=re.MULTILINE)
    for line in [one for one in locked.splitlines() if " install " in one and "pip" in one]:
        assert re.search(r"--require-hashes|\$\((?:\w+_)?PACKAGES\)|--no-index", line), line


@pytest.mark.parametrize("name", WORKFLOWS)
def test_jobs_have_no_rights_but_those_they_name(name: str) -> None:
    data = yaml.safe_load((ROOT / name).read_text(encoding="utf-8"))
    assert data["permissions"] == {}
    assert all(job["permissions"] for job in data["jobs"].values())


def test_owners_stand_at_what_is_run_with_rights() -> None:
    lines = (ROOT / ".github/CODEOWNERS").read_text(encoding="utf-8").splitlines()
    owned = {line.split()[0] for line in lines if line and not line.startswith("#")}
    assert {"*", "/.github/", "/ci/", "/action.yml", "/comment/"} <= owned
