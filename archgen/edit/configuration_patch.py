"""A proposed configuration written into the files of a project: a patch, proven by reading it and analysing it anew."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from archgen import pipeline
from archgen.edit.adopted_remedies import ValueChange, edit_file
from archgen.edit.edit_proof import first_file_of, list_new_errors
from archgen.edit.element_edit import EditRefusedError, FileEdit
from archgen.model.node import Node
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import load_from_files
from archgen.syntax.project_files import OverlaidFiles
from archgen.syntax.yaml_tree import find_value
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.change_trials import TriedChange
from archgen.timing.search.proposals import TriedConfiguration
from archgen.timing.system.activity_builder import name_activities

_Path = tuple[str, ...]


def plan_patch(
    checked_project: CheckedProject, configuration: TriedConfiguration, variants: Sequence[str] = ()
) -> tuple[FileEdit, ...]:
    """Return the files as a configuration wants them. Raise EditRefusedError where that is not sure to be what was analysed."""
    changes_by_file: dict[str, list[ValueChange]] = {}
    planner = _PatchPlanner(checked_project)
    for change in configuration.changes:
        for file, value_change in planner.locate_change(change):
            changes_by_file.setdefault(file, []).append(value_change)
    edits = tuple(edit_file(checked_project, file, changes) for file, changes in changes_by_file.items())
    _prove(checked_project, edits, configuration, variants)
    return edits


class _PatchPlanner:
    def __init__(self, checked_project: CheckedProject) -> None:
        self._documents = checked_project.loaded_project.documents
        self._architecture = checked_project.architecture
        self._owners = {name: key for key, name in name_activities(self._architecture).items()}

    def locate_change(self, change: TriedChange) -> Iterator[tuple[str, ValueChange]]:
        """Yield what a change is in the files. Raise EditRefusedError where it has no place."""
        if change.key == "container":
            yield self._leave_container(self._architecture.nodes[change.element])
            return
        key = change.key.removeprefix("timing.")
        value: object = change.value[1:-1].split(",") if change.value.startswith("[") else int(change.value)
        for path_choices in self._list_timing_paths(change.element):
            if key == "trigger":
                yield from self._replace_clock(path_choices, value)
            else:
                file, path = self._find_place(path_choices, key)
                yield file, ValueChange(path, key, value)

    def _leave_container(self, node: Node) -> tuple[str, ValueChange]:
        path = ("nodes", node.id)
        file, _ = self._find_place([path], "container", must_exist=True)
        if self._find_file([path], "host") or node.host is None:
            return file, ValueChange(path, "container", None)
        return file, ValueChange(path, "host", node.host, "container")

    def _replace_clock(self, path_choices: Sequence[_Path], value: object) -> Iterator[tuple[str, ValueChange]]:
        """Yield what puts a trigger in the place of a rate or a period."""
        clock_key = next((key for key in ("rate", "period") if self._find_file(path_choices, key)), "rate")
        file, path = self._find_place(path_choices, clock_key, must_exist=True)
        yield file, ValueChange(path, "trigger", value, clock_key)
        if self._find_file(path_choices, "behaviour"):
            file, path = self._find_place(path_choices, "behaviour")
            yield file, ValueChange(path, "behaviour", "event")

    def _list_timing_paths(self, element: str) -> Iterator[list[_Path]]:
        """Yield for each activity of an element the mappings in which its timing may be written, the likeliest first."""
        node = self._architecture.nodes.get(element)
        component = None if node else self._owners[element][1]
        node = node or self._architecture.nodes[self._owners[element][0]]
        node_path = ("nodes", node.id, "timing")
        if len(node.implements) <= 1 or (component is None and self._follow(node_path)):
            own_paths = [path for each in node.implements for path in _list_component_paths(each)]
            yield [node_path, *(own_paths if len(node.implements) == 1 else [])]
            return
        for each in node.implements if component is None else (component,):
            yield list(_list_component_paths(each))

    def _find_place(self, paths: Sequence[_Path], key: str, *, must_exist: bool = False) -> tuple[str, _Path]:
        """Return the file and the path at which a key is written, or else is to be. Raise EditRefusedError."""
        place = self._find_file(paths, key)
        if place is None and not must_exist:
            for ending in (0, 1):
                for path in paths:
                    file = self._follow(path[: len(path) - ending])
                    if file:
                        return file, path
        if place is None:
            raise EditRefusedError(f"no file of the project says `{key}` of `{paths[0][1]}` in a place of its own")
        return place

    def _find_file(self, paths: Sequence[_Path], key: str) -> tuple[str, _Path] | None:
        return next(((file, path) for path in paths if (file := self._follow((*path, key)))), None)

    def _follow(self, path: _Path) -> str | None:
        """Return the file in which something is written at a path."""
        return next((each.file for each in self._documents if find_value(each.root, *path) is not None), None)


def _list_component_paths(component: str) -> Iterator[_Path]:
    """Yield where a component's timing may be written: its path in one key, or in one mapping inside of another."""
    group, _, inner = component.partition(".")
    yield ("groups", group, "components", inner, "timing")
    if "." in inner:
        yield ("groups", group, *(key for part in inner.split(".") for key in ("components", part)), "timing")


def _prove(
    checked_project: CheckedProject,
    edits: Sequence[FileEdit],
    configuration: TriedConfiguration,
    variants: Sequence[str],
) -> None:
    """Read the project with the edits, and hold its chains against what was analysed. Raise EditRefusedError."""
    files = checked_project.loaded_project.files
    overlaid = OverlaidFiles(files.root, {edit.file: edit.new_content for edit in edits}, files)
    changed = pipeline.judge_project(load_from_files(overlaid, first_file_of(checked_project)))
    errors = tuple(list_new_errors(checked_project, changed))
    if errors:
        raise EditRefusedError("with it the project would have errors that it does not have now", errors=errors)
    architecture = pipeline.stand_in_variants(changed, variants).architecture if variants else changed.architecture
    chains = bound_all_chains(analyse_architecture(architecture), architecture)
    for name, bound in configuration.bounds.items():
        slack, deadline = chains[name].slack, chains[name].deadline
        found = None if slack is None or deadline is None or deadline.value is None else deadline.value - slack
        if found != bound:
            message = f"what is written decides otherwise: `{name}` would take {_write(found)}, not {_write(bound)}"
            raise EditRefusedError(message)


def _write(bound: Fraction | None) -> str:
    return "no bound" if bound is None else format_duration(bound)
