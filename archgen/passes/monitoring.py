"""The pass that lets every component say how it is: a state port on each, and a monitor in each that holds others."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.element_origins import TreePath
from archgen.link import mapping_values
from archgen.model.element_ids import make_unique_id
from archgen.model.path_resolver import title_from_id
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.written_places import Holder, find_type_of, is_existing, list_holders
from archgen.project.library_reading import SHIPPED_ID
from archgen.syntax.yaml_tree import MappingNode

MONITOR_TAG = "state_monitor"
"""The tag of monitors that the pass made: by it they are known again."""
STATE_MESSAGE = "diagnostic_msgs/msg/DiagnosticStatus"
_STATE_NAMES = ("state", "own_state", "reported_state")
_HOLDER_SECTIONS = frozenset({"groups", "component_types", "libraries"})
_MONITOR_NAMES = ("monitor", "state_monitor")


def _add_monitors(work: PassWork) -> None:
    _MonitorWriter(work).write_all()


class _MonitorWriter:
    """Writes state ports and monitors where components and their types are written."""

    def __init__(self, work: PassWork) -> None:
        self._work = work
        self._tree = work.tree
        self._state_ports: dict[TreePath, str | None] = {}
        self._watched_paths: set[TreePath] = set()

    def write_all(self) -> None:
        holders = [each for each in list_holders(self._tree) if self._is_declared(each.path)]
        for holder in holders:
            if len(holder.path) > 2 or self._is_type(holder.path):  # noqa: PLR2004 - a group is no component
                self._find_state_port(holder.path)
        # Inner ones first: what is around asks whether they have a state.
        for holder in reversed(holders):
            self._write_monitor(holder)

    def _is_declared(self, path: TreePath) -> bool:
        """Whether a component is declared where it stands: what changes something inside of an instance declares nothing."""
        if self._is_foreign(path):
            return False
        around = path[:-2]
        while around and around[-1] not in _HOLDER_SECTIONS:
            is_type = self._is_type(around)
            name = str(path[len(around) + 1])
            if self._has_inherited(around, name) or (find_type_of(self._tree, around) is not None and not is_type):
                return False
            if is_type or around[-2] != "components":
                break
            around = around[:-2]
        return True

    def _is_type(self, path: TreePath) -> bool:
        own_length = {"component_types": 2, "libraries": 4}
        return len(path) == own_length.get(str(path[0]), 0)

    def _is_foreign(self, path: TreePath) -> bool:
        return path[0] == "libraries" and path[1] == SHIPPED_ID

    def _find_state_port(self, path: TreePath) -> str | None:
        """Return the output by which a component, or a type, says how it is, made where there is none."""
        if path not in self._state_ports:
            self._state_ports[path] = None
            self._state_ports[path] = self._make_state_port(path)
        return self._state_ports[path]

    def _make_state_port(self, path: TreePath) -> str | None:
        if self._is_foreign(path) or self._is_monitor(path):
            return None
        type_path = find_type_of(self._tree, path)
        if type_path is not None:
            return self._find_state_port(type_path)
        outputs = self._tree.get_mapping((*path, "outputs"))
        inner_names = self._tree.get_mapping((*path, "components"))
        for name in _STATE_NAMES:
            body = mapping_values.get_body(outputs[name]) if name in outputs else None
            if body is not None and self._carries_messages(body):
                return name
            if body is None and name not in inner_names:
                if is_existing(self._tree, path):
                    return None
                type_name = self._make_state_type(path)
                self._tree.set((*path, "outputs", name), {"type": type_name}, path)
                return name
        return None

    def _carries_messages(self, output: MappingNode) -> bool:
        medium = mapping_values.get_medium(output, "medium")
        type_name = mapping_values.normalise_type_name(mapping_values.get_text(output, "type") or "")
        conceptual_type = self._work.link().declared_types.types.get(type_name)
        message = conceptual_type.message if conceptual_type else None
        return medium is None and (message is None or "/msg/" in message)

    def _make_state_type(self, path: TreePath) -> str:
        """Return the data type of a component's state, written where there is none of this name and message."""
        name = str(path[-1])
        wanted = f"{title_from_id(name).capitalize()} state"
        number, type_name = 1, wanted
        while True:
            written = self._tree.get(("types", type_name))
            if written is None:
                self._tree.set(("types", type_name), {"message": STATE_MESSAGE}, path)
                return type_name
            if isinstance(written, MappingNode) and mapping_values.get_text(written, "message") == STATE_MESSAGE:
                return type_name
            number += 1
            type_name = f"{wanted} {number}"

    def _is_monitor(self, path: TreePath) -> bool:
        body = self._tree.get(path)
        return isinstance(body, MappingNode) and MONITOR_TAG in mapping_values.get_texts(body, "tags")

    def _write_monitor(self, holder: Holder) -> None:
        """Write the monitor of what holds components, with an input for each state inside."""
        if holder.path in self._watched_paths:
            return
        self._watched_paths.add(holder.path)
        base = find_type_of(self._tree, holder.path) if self._is_type(holder.path) else None
        if base is not None and not self._is_foreign(base):
            # What it is made from may bring a monitor, which then watches what it adds.
            self._write_monitor(Holder(base, self._tree.get_mapping(base[:-1])[str(base[-1])]))
        watched = dict(self._list_watched(holder.path))
        if not watched:
            return
        monitor_name = self._find_monitor(holder.path)
        monitor_path: TreePath = (*holder.path, "components", monitor_name)
        title = mapping_values.get_text(mapping_values.get_body(holder.entry), "title") or title_from_id(
            holder.entry.key
        )
        is_made = self._tree.get(monitor_path) is None and not self._has_inherited(holder.path, monitor_name)
        if is_made:
            self._tree.set(monitor_path, {"functionality": f"Watches how the parts of {title} are."}, holder.path)
            self._tree.set((*monitor_path, "tags"), [MONITOR_TAG], holder.path)
        used_names: set[str] = set(self._tree.get_mapping((*monitor_path, "inputs")))
        for child, state_port in watched.items():
            source = f"{child}.{state_port}"
            if self._reads(monitor_path, source):
                continue
            input_name = make_unique_id(f"{child}_state", used_names)
            used_names.add(input_name)
            child_path = (*holder.path, "components", child)
            self._tree.set((*monitor_path, "inputs", input_name, "from"), [source], child_path)
        self._give_state_on(holder.path, monitor_path)

    def _reads(self, monitor_path: TreePath, source: str) -> bool:
        inputs = self._tree.get_mapping((*monitor_path, "inputs"))
        return any(
            source in mapping_values.get_texts(mapping_values.get_body(each), "from") for each in inputs.values()
        )

    def _list_watched(self, path: TreePath) -> Iterator[tuple[str, str]]:
        """Yield what stands directly inside and is not had from a type, with the output that says how it is."""
        type_path = None if path[0] == "groups" and len(path) == 2 else find_type_of(self._tree, path)  # noqa: PLR2004
        if type_path is not None and not self._is_type(path):
            return
        for name in list(self._tree.get_mapping((*path, "components"))):
            inner_path = (*path, "components", name)
            if type_path is not None and self._has_inherited(path, name):
                continue
            state_port = self._find_state_port(inner_path)
            if state_port is not None:
                yield name, state_port

    def _has_inherited(self, path: TreePath, name: str) -> bool:
        """Whether a type has a component from a type that it is made from."""
        seen: set[TreePath] = set()
        base = find_type_of(self._tree, path) if len(path) != 2 or path[0] != "groups" else None  # noqa: PLR2004
        while base is not None and base not in seen:
            seen.add(base)
            if name in self._tree.get_mapping((*base, "components")):
                return True
            base = find_type_of(self._tree, base)
        return False

    def _find_monitor(self, path: TreePath) -> str:
        """Return the name of the monitor of what holds components: the one that is there, or one that is free."""
        base: TreePath | None = path
        seen: set[TreePath] = set()
        while base is not None and base not in seen:
            seen.add(base)
            for name in self._tree.get_mapping((*base, "components")):
                if self._is_monitor((*base, "components", name)):
                    return name
            base = find_type_of(self._tree, base) if base[0] != "groups" or len(base) > 2 else None  # noqa: PLR2004
        taken = {*self._tree.get_mapping((*path, "components")), *self._tree.get_mapping((*path, "outputs"))}
        free_name = next((name for name in _MONITOR_NAMES if name not in taken), None)
        return free_name or make_unique_id(_MONITOR_NAMES[-1], taken)

    def _give_state_on(self, path: TreePath, monitor_path: TreePath) -> None:
        """Let a composed component say how it is by its monitor, unless it says so already."""
        state_port = self._state_ports.get(path)
        output_path = (*path, "outputs", state_port or "")
        if (
            state_port is None
            or self._tree.get(output_path) is None
            or self._tree.get((*output_path, "from")) is not None
        ):
            return
        if not self._tree.trace(output_path).passes:
            return
        type_name = self._tree.get_text((*output_path, "type"))
        self._tree.set((*monitor_path, "outputs", "state"), {"type": type_name}, path)
        self._tree.set((*output_path, "from"), [f"{monitor_path[-1]}.state"], path)


MONITOR = Pass(
    "monitor",
    "Adds a state port to every component, and to all that holds components a monitor that reads them.",
    _add_monitors,
    needs=("no_component_sources", "no_autoconnect_ports", "no_autoconnect_types"),
    leaves=("monitored",),
)
