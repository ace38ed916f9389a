"""Decide which files a new project gets, where they go, and which of them exist already; set up git to merge them by what
they say.

The YAML files of a new project, as a person would write them. The driver that merges is a line in .gitattributes and two
settings of git, with a hook that checks after a merge.
"""

from __future__ import annotations

import os
import shlex
import shutil
import sys
from collections.abc import Mapping
from itertools import chain
from pathlib import Path
from typing import Any, Literal

from archgen import git, pipeline
from archgen.checking import code_ownership
from archgen.emit import file_tree
from archgen.emit.codeowners_file import CODEOWNERS_PATHS
from archgen.frozen import NamedTuple, dataclass
from archgen.git.git_call import run_git
from archgen.model.project_settings import agreement_file
from archgen.pipeline import CheckedProject
from archgen.products import editor_schema_file, editor_schema_marks
from archgen.products.editor_schema_marks import SCHEMA_FILE
from archgen.project import PROJECT_FILE
from archgen.project.project_loading import load_from_files, load_project
from archgen.start import start_templates
from archgen.start.start_answers import StartAnswers
from archgen.syntax import block_documents
from archgen.syntax.file_patterns import YAML_ENDINGS
from archgen.syntax.project_files import OverlaidFiles


@dataclass(frozen=True, slots=True)
class ProjectPlan:
    """Files to write (by absolute path), files kept because they exist, and the folder that holds all of them: the
    repository's.
    """

    files: Mapping[Path, bytes]
    existing_files: tuple[Path, ...]
    repository_folder: Path
    reviewers_missing: bool


def judge_files(files: Mapping[str, bytes], name: str) -> CheckedProject:
    """Check the files of a project before they are written."""
    return pipeline.judge_project(load_from_files(OverlaidFiles(Path(name), files), PROJECT_FILE))


def plan_files(
    folder: Path, answers: StartAnswers, yaml_files: Mapping[str, bytes], checked_project: CheckedProject
) -> ProjectPlan:
    """Put the files together: the project's in its folder, what the forge reads at the top of the repository."""
    # Resolved, so that it can be relative to the repository's folder even through a symbolic link.
    target = Path(os.path.realpath(folder))
    repository_folder = _find_repository(target) or target
    prefix = "" if target == repository_folder else target.relative_to(repository_folder).as_posix()
    wanted_files = {
        target / name: data for name, data in {**yaml_files, **_project_files(answers, checked_project)}.items()
    }
    wanted_files |= {
        repository_folder / name: data for name, data in _forge_files(answers, prefix, repository_folder).items()
    }
    reviewers_missing = bool(answers.partners) and not any(partner.reviewers for partner in answers.partners)
    if any(partner.reviewers for partner in answers.partners):
        # Without a forge any of them may be meant.
        possible_paths = CODEOWNERS_PATHS.get(answers.forge) or dict.fromkeys(chain(*CODEOWNERS_PATHS.values()))
        codeowners_path = next(
            (name for name in possible_paths if os.path.lexists(repository_folder / name)), "CODEOWNERS"
        )
        wanted_files[repository_folder / codeowners_path] = code_ownership.make_codeowners(
            checked_project, prefix
        ).text.encode()
    # `lexists`: a broken symbolic link is kept as well.
    existing_files = tuple(path for path in wanted_files if os.path.lexists(path))
    return ProjectPlan(
        {path: data for path, data in wanted_files.items() if path not in existing_files},
        existing_files,
        repository_folder,
        reviewers_missing,
    )


def _project_files(answers: StartAnswers, checked_project: CheckedProject) -> dict[str, bytes]:
    return {
        editor_schema_marks.SCHEMA_FILE: editor_schema_file.render_schema(checked_project),
        ".vscode/settings.json": start_templates.read_plain_file("vscode/settings.json"),
        ".vscode/extensions.json": start_templates.read_plain_file("vscode/extensions.json"),
        ".gitignore": start_templates.read_plain_file("gitignore"),
        ".gitattributes": start_templates.read_plain_file("gitattributes"),
        "README.md": start_templates.fill_readme(answers),
    }


def _forge_files(answers: StartAnswers, project_path: str, repository_folder: Path) -> dict[str, bytes]:
    if answers.forge == "github":
        folder, name = ".github/workflows", "architecture.yml"
        # The workflow of another project, which never checks this one.
        is_taken = bool(project_path) and os.path.lexists(repository_folder / folder / name)
        if is_taken:
            name = f"architecture-{start_templates.make_project_slug(project_path) or 'project'}.yml"
        return {
            f"{folder}/{name}": start_templates.fill_workflow(project_path, publishes=not is_taken),
            f"{folder}/{name.replace('architecture', 'open-requests', 1)}": start_templates.fill_nightly_workflow(
                project_path
            ),
        }
    return {".gitlab-ci.yml": start_templates.fill_pipeline(project_path)} if answers.forge == "gitlab" else {}


def _find_repository(folder: Path) -> Path | None:
    """Return the top of the git repository around a folder, by its `.git`; git itself is not called."""
    return next((ancestor for ancestor in (folder, *folder.parents) if os.path.lexists(ancestor / ".git")), None)


_EXAMPLE_REQUIREMENT = "The robot touches neither people nor things that it should not touch"
_KEY_HINTS = {
    "functionality": "# what it does, in a sentence or two",
    "inputs": "# id: group.component.output",
    "outputs": "# id: conceptual type",
}
_OUTPUT_HINT = "# of which conceptual type?"
_SECTION_HINTS = {
    "requirements": "# components name what they serve; archgen says what nobody serves",
    "types": "# conceptual types and the ROS messages that carry them",
}


def example_files(answers: StartAnswers) -> dict[str, bytes]:
    """Return the files of a project that begins with an example, or with groups that are empty."""
    if answers.is_empty:
        bodies = {
            group.id: {"title": group.title, **({"owner": group.owner} if group.owner else {}), "components": {}}
            for group in answers.groups
        }
        return imported_files(answers, {"groups": bodies})
    sections = {"requirements": {"R-1": _EXAMPLE_REQUIREMENT}}
    return {
        PROJECT_FILE: _fill_project_file(answers, sections),
        **start_templates.fill_group_files(answers),
        **_agreement_files(answers),
    }


def _agreement_files(answers: StartAnswers) -> dict[str, bytes]:
    return {agreement_file(partner.id): start_templates.fill_agreements(partner.title) for partner in answers.partners}


def imported_files(answers: StartAnswers, data: Mapping[str, Any]) -> dict[str, bytes]:
    """Return the files of a project whose groups, nodes, types and requirements were imported."""
    files = {PROJECT_FILE: _fill_project_file(answers, data)}
    for name, group in data.get("groups", {}).items():
        # With the dot, so that the group `arm` does not take the nodes of `arm_left`.
        id_prefix = f"{name}."
        nodes = {
            key: node for key, node in data.get("nodes", {}).items() if _first_implemented(node).startswith(id_prefix)
        }
        files[f"groups/{name}.yaml"] = _write_slice(name, group, nodes).encode()
    return files | _agreement_files(answers)


def _fill_project_file(answers: StartAnswers, data: Mapping[str, Any]) -> bytes:
    """Return archgen.yaml: the template, and below it the sections that the data have."""
    sections = block_documents.BlockMapping()
    for key, hint in _SECTION_HINTS.items():
        if key in data:
            section = sections.add_mapping(key, hint, is_spaced=True)
            for name, value in data[key].items():
                section.add_entry(name, value)
    project_file = start_templates.fill_project_file(answers)
    return project_file + (block_documents.write_document(sections).encode() if sections.content else b"")


def _first_implemented(node: Mapping[str, Any]) -> str:
    """Return the first component that a node implements: it decides into which group's file the node goes."""
    implements = node["implements"]
    return str(implements if isinstance(implements, str) else implements[0])


_SCHEMA_LINE = f"# yaml-language-server: $schema=../{SCHEMA_FILE}\n"


def _write_slice(name: str, group: Mapping[str, Any], nodes: Mapping[str, Any]) -> str:
    root = block_documents.BlockMapping()
    group_mapping = root.add_mapping("groups").add_mapping(name)
    for key, value in group.items():
        if key != "components":
            group_mapping.add_entry(key, value)
    if not group["components"]:
        group_mapping.add_entry("components", None, "# `archgen new component` adds one")
        return block_documents.write_document(root, _SCHEMA_LINE)
    components = group_mapping.add_mapping("components")
    for component, body in group["components"].items():
        _add_component(components.add_mapping(component, is_spaced=True), body)
    if nodes:
        node_section = root.add_mapping("nodes", is_spaced=True)
        for node, body in nodes.items():
            node_mapping = node_section.add_mapping(node)
            for key, value in body.items():
                node_mapping.add_entry(key, value)
    return block_documents.write_document(root, _SCHEMA_LINE)


def _add_component(component: block_documents.BlockMapping, body: Mapping[str, Any]) -> None:
    """Add the keys of a component; unknown keys are left empty, with a comment on what belongs there."""
    keys = dict.fromkeys((*(key for key in body if key not in {"inputs", "outputs"}), "functionality"))
    for key in keys:
        component.add_entry(key, body.get(key), _KEY_HINTS.get(key, ""))
    for key in ("inputs", "outputs"):
        if ports := body.get(key):
            port_section = component.add_mapping(key)
            for port, value in ports.items():
                port_section.add_entry(port, value, _OUTPUT_HINT if key == "outputs" else "")
        else:
            component.add_entry(key, ports, _KEY_HINTS[key])


_HOOK = "post-merge"
_HEADER = "#!/bin/sh\n# archgen init --merge-driver wrote this: git merges files, here the whole is checked.\n"


class MergeHook(NamedTuple):
    """The hook of a clone, and the lines in it that check a project: written now, there already, or still to be written by
    people, since the hook is theirs.
    """

    path: Path
    lines: str
    state: Literal["written", "kept", "missing"]


def install_merge_hook(folder: Path) -> MergeHook:
    """Write the lines into the hook, unless git looks elsewhere for hooks or somebody wrote one: that is left alone.

    Raise `git.NoRepositoryError`, OutputError or OSError.
    """
    repository = git.find_repository(folder)
    lines = _write_check(repository.prefix or ".")
    path = _find_hook(repository.top)
    content = path.read_bytes().decode("utf-8", "replace") if path.is_file() else ""
    is_ours = content.startswith(_HEADER) and not path.is_symlink()
    if lines in content:
        return MergeHook(path, lines, state="kept")
    if _has_own_hook_folder(repository.top) or (os.path.lexists(path) and not is_ours):
        return MergeHook(path, lines, state="missing")
    path.parent.mkdir(exist_ok=True)
    file_tree.replace_file(path, (f"{content or _HEADER}{lines}").encode())
    path.chmod(0o755)
    return MergeHook(path, lines, state="written")


def _write_check(project: str) -> str:
    # ORIG_HEAD is what was there before the merge: only what came with it is said.
    return (
        f"{find_program()} check {shlex.quote(project)} --quiet --changed-since ORIG_HEAD >&2\n"
        '[ $? -ne 1 ] || echo "archgen: git merged, and the architecture has errors" >&2\n'
    )


def _find_hook(top: Path) -> Path:
    # Worktrees share the hooks of their repository.
    return top / run_git(top, "rev-parse", "--git-common-dir").text.removesuffix("\n") / "hooks" / _HOOK


def _has_own_hook_folder(top: Path) -> bool:
    """Whether a setting names another folder for hooks, such as one that is shared. archgen's calls of git overrule it."""
    return any(
        run_git(top, "config", scope, "--get", "core.hooksPath").status == 0
        for scope in ("--local", "--global", "--system")
    )


ATTRIBUTES_FILE = ".gitattributes"
_PATTERNS = tuple(f"*{ending}".encode() for ending in YAML_ENDINGS)
_ATTRIBUTE = b"merge=archgen"
_DRIVER_ARGUMENTS = "merge-driver --marker-size=%L %O %A %B %P"


def list_driver_settings() -> dict[str, str]:
    """Return the settings of git that name the driver."""
    return {
        "merge.archgen.name": "slices of archgen by what they say",
        "merge.archgen.driver": f"{find_program()} {_DRIVER_ARGUMENTS}",
    }


def find_program() -> str:
    """Return how the shell that git calls starts archgen: by this Python where it would not find `archgen`.

    git takes a driver that is missing for a conflict, and leaves our side without any marker.
    """
    return "archgen" if shutil.which("archgen") else f"{shlex.quote(Path(sys.executable).as_posix())} -m archgen"


def format_setting(name: str, value: str) -> str:
    """Return the command that makes a setting."""
    return f"git config --local {name} {shlex.quote(value)}"


def list_outer_libraries(folder: Path) -> tuple[Path, ...]:
    """Return the folders of a project's libraries that lie outside of its own: its .gitattributes do not reach them."""
    libraries = load_project(folder).libraries
    return tuple(dict.fromkeys(folder / library.folder for library in libraries if library.folder.startswith("../")))


def add_attribute(folder: Path) -> bool:
    """Add the lines to the .gitattributes of a project or library, behind what is there. Return whether one was missing.

    Raise OutputError for a symbolic link, which git does not read, and OSError.
    """
    path = folder / ATTRIBUTES_FILE
    if path.is_symlink():
        msg = f"{path} is a symbolic link, which git does not read; nothing was written"
        lines = " and ".join(f"`{(pattern + b' ' + _ATTRIBUTE).decode()}`" for pattern in _PATTERNS)
        raise file_tree.OutputError(msg, f"make it a file with the lines {lines}")
    content = path.read_bytes() if path.exists() else b""
    missing_patterns = [pattern for pattern in _PATTERNS if not _is_set(content, pattern)]
    if not missing_patterns:
        return False
    line_end = b"\r\n" if b"\r\n" in content else b"\n"
    separator = b"" if not content or content.endswith(b"\n") else line_end
    new_lines = b"".join(pattern + b" " + _ATTRIBUTE + line_end for pattern in missing_patterns)
    file_tree.replace_file(path, content + separator + new_lines)
    return True


def _is_set(content: bytes, pattern: bytes) -> bool:
    """Whether files of a pattern are merged by archgen. The last line counts: another driver behind ours would be taken."""
    lines = (line.split() for line in content.splitlines())
    merge_lines = [words for words in lines if words[:1] == [pattern] and _sets_merge(words)]
    return bool(merge_lines) and _ATTRIBUTE in merge_lines[-1]


def _sets_merge(words: list[bytes]) -> bool:
    return any(word.lstrip(b"-!").partition(b"=")[0] == b"merge" for word in words[1:])


def configure_git(folder: Path) -> None:
    """Make the settings in the repository around a folder. Raise `git.NoRepositoryError` or `git.GitError`."""
    repository = git.find_repository(folder)
    for name, value in list_driver_settings().items():
        result = run_git(repository.top, "config", "--local", name, value)
        if result.status:
            raise git.GitError(f"git does not take the setting {name}: {result.error_text}")
