"""What a view for generators is made from, and what it gives back: plain data, and what could not be generated."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cached_property
from typing import TYPE_CHECKING, Any

from archgen.bringup.plan_shapes import StartPlan
from archgen.diagnostics import NO_SPAN, Diagnostic, Rule, Severity, Span
from archgen.frozen import dataclass, field
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.model.ros_distro import is_ros_1

if TYPE_CHECKING:
    from archgen.views.pages.report_outline import DetailLevel

_PLAIN_SELECTOR = re.compile(r"[a-z0-9_]{1,80}(?:[.:][a-z0-9_]{1,80}){0,3}\Z")
_DIGEST_LENGTH = 8

NOT_GENERATED = Rule(
    "not-generated",
    Severity.ERROR,
    "Something of the architecture cannot be generated.",
    fixed=True,
)
"""What `archgen generate` says of an element that is left out. `archgen check` never says it."""


@dataclass(frozen=True, slots=True)
class GeneratedView:
    """A view: dicts, lists, texts and numbers for templates, and what of the architecture is not in it."""

    data: Mapping[str, Any]
    findings: tuple[Diagnostic, ...] = ()


# Without slots: `cached_property` stores its values in the object's dictionary.
@dataclass(frozen=True)
class GenerationContext:
    """The architecture, in the variant and after the passes that were asked for, and the part to generate from."""

    architecture: Architecture
    components: frozenset[str] | None = None
    """The complete ids of the components that `--select` names; None for all."""
    nodes: frozenset[str] | None = None
    host: str | None = None
    """The only host to generate for; None for all."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """What the manifest says under `options`, as texts, with what `--option` says instead."""
    backend: str = ""
    """The id of the backend: elements have hints for it below this name."""
    level: DetailLevel = "implementation"
    """Whether the view `structure` shows the ROS side."""
    selector: str = ""
    """What `--select` says."""
    types_only: bool = False
    """Whether only the component types are asked for: `--select type:` of an export that has them."""
    pack_project: Callable[[], Mapping[str, Any]] = dict
    """Returns the project as `archgen pack` writes it; without one, nothing is written."""

    @property
    def is_whole(self) -> bool:
        """Whether everything is asked for."""
        return self.components is None and self.host is None

    @property
    def element_count(self) -> int:
        """How many components and nodes there are, asked for or not: what templates may use depends on it."""
        return len(self.architecture.components) + len(self.architecture.nodes)

    @property
    def part(self) -> str:
        """What files are called after that several parts of `--select` would make: `owner-certh`; empty where nothing is selected.

        Different selectors have different names, also where case is ignored.
        """
        text = " ".join(self.selector.split())
        if not text or _PLAIN_SELECTOR.match(text):
            return text.replace(":", "-")
        words = re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")[:40]
        return f"{words}-{hashlib.sha256(text.encode()).hexdigest()[:_DIGEST_LENGTH]}"

    @cached_property
    def wanted_nodes(self) -> Mapping[str, Node]:
        """The nodes to generate for, by id: the selected ones, on the host that is asked for."""
        return {
            node.id: node
            for node in self.architecture.nodes.values()
            if (self.nodes is None or node.id in self.nodes) and (self.host is None or node.host == self.host)
        }

    @cached_property
    def wanted_components(self) -> Collection[str]:
        """The complete ids of the components to generate for, in their order: with a host those that its nodes implement."""
        implemented = {leaf for node in self.wanted_nodes.values() for leaf in node.implements}
        return {
            component_id: None
            for component_id in self.architecture.components
            if (self.components is None or component_id in self.components)
            and (self.host is None or component_id in implemented)
        }

    @cached_property
    def implementing_nodes(self) -> Mapping[str, list[Node]]:
        """The nodes of each component, asked for or not, by the component's complete id."""
        nodes = self.architecture.nodes.values()
        return group_pairs((component, node) for node in nodes for component in dict.fromkeys(node.implements))

    @cached_property
    def nodes_by_component(self) -> Mapping[str, Node]:
        """The node of each component, asked for or not, by the component's complete id; of several the first."""
        return {component_id: nodes[0] for component_id, nodes in self.implementing_nodes.items()}

    @property
    def ros_generation(self) -> int:
        """The generation of ROS to generate for, 1 or 2: the option `ros`, else that of the project's distribution."""
        return {"1": 1, "2": 2}.get(self.options.get("ros", ""), 1 if is_ros_1(self.architecture.distro) else 2)


_MODEL_PATHS: ContextVar[Mapping[str, str] | None] = ContextVar("model_paths", default=None)


@contextmanager
def give_model_paths(paths: Mapping[str, str]) -> Iterator[None]:
    """Let `write_place` return paths in the model, which are given by where their elements are written."""
    token = _MODEL_PATHS.set(paths)
    try:
        yield
    finally:
        _MODEL_PATHS.reset(token)


def write_place(span: Span) -> str:
    """Return where an element is written, as `place` of what is generated for it; empty where it is written nowhere.

    In a workspace it is the element's path in the model, or the file of what has none there.
    """
    if span == NO_SPAN:
        return ""
    paths, place = _MODEL_PATHS.get(), str(span)
    return place if paths is None else paths.get(place) or span.file


def tell_left_out(message: str, span: Span, *, element: str | None = None, help_line: str | None = None) -> Diagnostic:
    """Report what a generator leaves out, and what to do about it."""
    return Diagnostic(NOT_GENERATED.name, message, span, NOT_GENERATED.severity, help=help_line, element=element)


def find_wanted_steps(plan: StartPlan, context: GenerationContext) -> frozenset[str]:
    """Return the steps of the wanted nodes, and those of the containers that load them."""
    nodes = context.wanted_nodes
    loading_containers = {node.container for node in nodes.values()}
    return frozenset(
        step.id
        for step in plan.steps
        if (
            step.container in loading_containers or (context.components is None and context.host in {None, step.host})
            if step.kind == "container"
            else step.id in nodes
        )
    )
