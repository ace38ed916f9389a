"""Component types as one classifier for all their instances: what most of these say stands there, the rest at each of them.

Sensors, motors and other things that no program is: devices of AADL, with their ports and the buses that they are on.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.generating import write_place
from archgen.plugin.model import Architecture, Component, ComponentType, Node, is_physical
from archgen.plugins.aadl.views.aadl_processes import Behaviour, NodeProcess
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    NameSpace,
    list_component_words,
    list_own_sources,
    make_classifier,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
    write_aadl_string,
)

_Key = tuple[str, str, str]
"""Of a property: the section that it stands in, what it applies to there, and its name."""
_TYPE_WORDS = frozenset({"archgen::Functionality", "archgen::Description", "archgen::Role", "archgen::Tags"})
"""What instances have from their types, of what a component says of itself."""
_INSTANCE_PROPERTIES = frozenset({"topic_properties::Default_Name", "Queue_Size", "archgen::External_End"})
"""What a node says, and what stands around an instance."""


@dataclass(frozen=True, slots=True)
class SharedType:
    """A component type with the processes, or devices, that are its instances and alike."""

    declared: ComponentType
    name: str
    instances: tuple[NodeProcess, ...]


def find_type_of_node(architecture: Architecture, node: Node) -> ComponentType | None:
    """Return the component type of the only component that a node implements; none for generic types and those of libraries."""
    component = architecture.find_component(node.implements[0]) if len(node.implements) == 1 else None
    if component is None or not component.component_type or node.wholes:
        return None
    declared = architecture.component_types.get(component.component_type)
    has_hints = "aadl" in component.annotations.hints or "aadl" in node.annotations.hints
    return declared if declared and declared.library is None and not has_hints else None


def list_shared_types(
    architecture: Architecture, processes: Iterable[NodeProcess], names: Mapping[tuple[str, str], str]
) -> list[SharedType]:
    """Return the types with their instances; `names` are what their classifiers are called, by category and id."""
    instances: dict[tuple[str, str], list[NodeProcess]] = {}
    for process in processes:
        if declared := find_type_of_node(architecture, process.node):
            instances.setdefault((process.category, declared.id), []).append(process)
    return [
        SharedType(architecture.component_types[key[1]], names[key], tuple(_select_alike(found)))
        for key, found in instances.items()
    ]


def _select_alike(processes: Sequence[NodeProcess]) -> list[NodeProcess]:
    """Return those that one classifier can stand for: as many as possible."""
    shapes = [_describe_shape(process) for process in processes]
    [(shape, _)] = Counter(shapes).most_common(1)
    alike: list[NodeProcess] = []
    texts: dict[tuple[str, str], str] = {}
    for process, own_shape in zip(processes, shapes, strict=True):
        own_texts = {("feature", each["name"]): each["text"] for each in process.feature_items}
        own_texts |= {("flow", each["name"]): f"{each['text']} {each['properties']}" for each in process.flows}
        if own_shape == shape and all(texts.get(key, text) == text for key, text in own_texts.items()):
            alike.append(process)
            texts |= own_texts
    return alike


def _describe_shape(process: NodeProcess) -> str:
    """Return a text that is equal for processes of which one classifier can be made."""
    features = [(each["name"], each["text"]) for each in process.feature_items if not _is_extra(each)]
    inside = [(each["name"], each["text"]) for each in (*process.connections, *process.subcomponents)]
    threads = [
        (each["category"], each["extends"], [(item["name"], item["text"]) for item in each["features"]])
        for each in process.thread_classifiers
    ]
    text = str((features, inside, threads))
    for index, each in enumerate(process.thread_classifiers[::2]):
        text = text.replace(f" {each['name']}.impl", f" {index}.impl")
    return text


def _is_extra(feature: Mapping[str, Any]) -> bool:
    """Whether it does no harm that an instance has a feature because others need it: buses, and calls as data."""
    is_call = any(each["name"] == "archgen::Is_Call" for each in feature["properties"])
    return is_call or feature["text"].startswith(("requires bus access ", "requires virtual bus access "))


class TypeWriter:
    """Writes a component type, and says at each instance what is otherwise there."""

    def __init__(self, shared: SharedType, package_name: str, package_names: NameSpace) -> None:
        """Look at all instances; the type goes into the package of this name, which has these names."""
        self._shared, self._package_name, self._package_names = shared, package_name, package_names
        self._first = shared.instances[0]
        self._said = [dict(_list_said(process)) for process in shared.instances]
        self._common = self._choose_common()

    def _choose_common(self) -> dict[_Key, str]:
        """Return the values that the type has: where all instances have one, that of most."""
        found: dict[_Key, str] = {}
        for key in self._said[0]:
            section, _, name = key
            is_of_type = name in _TYPE_WORDS if section == "words" else name not in _INSTANCE_PROPERTIES
            if is_of_type and all(key in said for said in self._said):
                [(found[key], _)] = Counter(said[key] for said in self._said).most_common(1)
        declared = self._shared.declared
        for name, text in (("Functionality", declared.functionality), ("Description", declared.description)):
            found.pop(("words", "", f"archgen::{name}"), None)
            if text:
                found["words", "", f"archgen::{name}"] = write_aadl_string(text)
        return found

    def place_instances(self) -> None:
        """Make the subcomponents of the type, with what each says otherwise."""
        for process, said in zip(self._shared.instances, self._said, strict=True):
            ending = "" if isinstance(process, NodeDevice) else ".impl"
            process.item["text"] = f"{process.category} {self._package_name}::{self._shared.name}{ending}"
            process.item["properties"] += [
                make_property(name, value, path)
                for (section, path, name), value in said.items()
                if self._common.get((section, path, name)) != value
            ]

    def make_classifiers(self) -> list[dict[str, Any]]:
        """Return the type, and for processes the implementation and the thread."""
        declared = self._shared.declared
        words = [make_property("archgen::Component_Type", write_aadl_string(declared.id))]
        words += make_named_properties(declared.id, declared.id, declared.title)
        words += make_text_properties(owner=declared.owner)
        words += self._list_common("words")
        own_type = make_classifier(self._first.category, self._shared.name, place=write_place(declared.at))
        own_type.update(features=self._merge_items("features"), flows=self._merge_items("flows"), properties=words)
        inside = self._list_common("inside")
        if isinstance(self._first, NodeDevice):
            own_type["properties"] = [*words, *inside]
            return [own_type]
        threads, names = self._copy_threads()
        implementation = make_classifier(self._first.category, f"{self._shared.name}.impl", extends="ros::node.impl")
        implementation.update(
            subcomponents=[
                {**each, "text": names.get(each["text"], each["text"])} for each in self._first.subcomponents
            ],
            connections=self._first.connections,
            properties=inside,
        )
        return [*threads, {**own_type, "extends": "ros::node"}, implementation]

    def _copy_threads(self) -> tuple[list[dict[str, Any]], dict[str, str]]:
        """Return the threads, called as the type is, and what subcomponents of them are made from."""
        threads: list[dict[str, Any]] = []
        names: dict[str, str] = {}
        for each in self._first.thread_classifiers:
            old_name = each["name"].partition(".")[0]
            if old_name == each["name"]:
                kind = "thread" if each["extends"].startswith("cnc::") else each["extends"].partition(" ")[0][5:]
                new_name = self._package_names.take_name(f"{kind}_{self._shared.name}")
                names[f"thread {old_name}.impl"] = f"thread {new_name}.impl"
            threads.append({**each, "name": each["name"].replace(old_name, new_name)})
        return threads, names

    def _merge_items(self, section: str) -> list[dict[str, Any]]:
        """Return the features or flows of all instances, each once, with what they have in common."""
        items: dict[str, dict[str, Any]] = {}
        for process in self._shared.instances:
            for each in process.feature_items if section == "features" else process.flows:
                if each["name"] not in items:
                    is_whole = section == "flows" or _is_extra(each)
                    properties = each["properties"] if is_whole else self._list_common(section, each["name"])
                    items[each["name"]] = make_item(each["name"], each["text"], properties)
        return list(items.values())

    def _list_common(self, section: str, path: str | None = None) -> list[AadlProperty]:
        return [
            make_property(key[2], value, key[1] if path is None else "")
            for key, value in self._common.items()
            if key[0] == section and path in {None, key[1]}
        ]


def _list_said(process: NodeProcess) -> Iterator[tuple[_Key, str]]:
    """Yield all properties of a process with their values."""
    for each in process.list_words():
        yield ("words", "", each["name"]), each["value"]
    for item in process.feature_items:
        for each in () if _is_extra(item) else item["properties"]:
            yield ("features", item["name"], each["name"]), each["value"]
    for each in process.properties:
        yield ("inside", each["applies_to"], each["name"]), each["value"]


_DEVICE_TAG = "device"


def is_device(architecture: Architecture, node: Node, linked_devices: Collection[str]) -> bool:
    """Return whether a node is only planned, for what is no program: a device by its tag, on a link, or by its ports."""
    component = architecture.find_component(node.implements[0]) if len(node.implements) == 1 else None
    if node.written or component is None:
        return False
    is_all_physical = bool(component.ports) and all(map(is_physical, component.ports))
    return _DEVICE_TAG in component.tags or component.id in linked_devices or is_all_physical


class NodeDevice(NodeProcess):
    """A component that is a device: as a process to all that is joined to it, but without threads and without ROS."""

    category = "device"
    reserved_names = ()
    may_use_tf = False

    @property
    def classifier(self) -> str:
        """What its subcomponent is made from, within its package."""
        return self.name

    @property
    def component(self) -> Component:
        """The component that is the device."""
        return next(iter(self.behaviours.values())).component

    def _add_thread(self, behaviour: Behaviour, package_names: NameSpace, *, is_only: bool) -> None:
        """Say of the device itself what would be said of its thread."""
        del package_names, is_only
        properties = behaviour.list_properties()
        jitter = behaviour.timing.jitter
        if jitter:
            # AADL has a jitter for threads alone.
            properties = [each for each in properties if each["name"] != "Dispatch_Jitter"]
            properties += make_text_properties(jitter=str(jitter))
        self.properties += properties
        features = {behaviour.port_names[part.key]: self.features[part.key] for part in behaviour.parts}
        self.properties += [
            {**each, "applies_to": features[each["applies_to"]]} for each in self._list_queue_sizes(behaviour)
        ]

    def add_bus_access(self, wanted_name: str, bus: str) -> str:
        """Add access to a bus, `bus access hosts::lan`; return what it is called."""
        name = self.names.take_name(wanted_name)
        self.feature_items.append(make_item(name, f"requires {bus}"))
        return name

    def list_words(self) -> list[AadlProperty]:
        """Return what it says of itself beside its ports and its timing."""
        component = self.component
        properties = make_named_properties(component.id, component.id, component.title)
        return properties + list_component_words(component, component.role, self.find_own_owner(component))

    def make_classifiers(self) -> list[dict[str, Any]]:
        """Return its type; what it consists of is not said."""
        properties = [*self.list_words(), *list_own_sources(self._hints), *self.properties]
        device = make_classifier("device", self.name, properties=properties, place=write_place(self.component.at))
        return [{**device, "features": self.feature_items, "flows": self.flows}]
