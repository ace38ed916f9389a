"""How what runs where, chains, policies, views and variants say is read for comparing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.compare.kinds.key_spec import ReadContext, Reader
from archgen.model.architecture import Chain, Policy
from archgen.model.coordinate_frames import Frame
from archgen.model.declared_timing import list_fair_figures
from archgen.model.deployment import Host, Link
from archgen.model.variant import Variant


def read_core_orders(host: Host, _context: ReadContext) -> Mapping[str, str]:
    """Return the order in which each core takes what is ready, and the figures of a fair one."""
    orders = {str(core): str(order) for core, order in host.core_scheduling.items()}
    return orders | {f"fair.{name}": figure for name, figure in list_fair_figures(host.fair)}


def find_latency(link: Link, _context: ReadContext) -> Link:
    """Return the link: it has the keys below `latency` itself."""
    return link


def find_forbidden_flow(policy: Policy, _context: ReadContext) -> Policy:
    """Return the policy: it has the keys below `forbid` itself."""
    return policy


def read_accepted(policy: Policy, context: ReadContext) -> Mapping[str, object]:
    """Return why a policy lets inputs pass, by their common ids."""
    return {str(context.common_id("input", name)): reason for name, reason in policy.accepted.items()}


def read_writer(frame: Frame, context: ReadContext) -> str | None:
    """Return the component or the node that writes a frame."""
    return context.common_id(frame.by_kind, frame.by)


def read_way(chain: Chain, context: ReadContext) -> tuple[str, ...]:
    """Return what a chain leads through."""
    return tuple(context.matched_ids.common_id(point.kind, point.id) for point in chain.through)


def make_selector_reader(attribute: str) -> Reader:
    """Return a reader of a selector, with the ids of the second version; None where none is written."""

    def read(element: Any, context: ReadContext) -> str | None:  # noqa: ANN401 - whatever has such a selector
        return context.matched_ids.rename_in_text(" ".join((getattr(element, attribute) or "").split())) or None

    return read


def read_variant_changes(variant: Variant, context: ReadContext) -> frozenset[str]:
    """Return what a variant writes over the project."""
    return frozenset(context.matched_ids.rename_in_text(f"{each.path}: {each.value}") for each in variant.changes)
