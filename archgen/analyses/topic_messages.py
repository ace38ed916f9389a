"""Does every topic, service and action carry only one message?"""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import NO_SPAN, Span, first_written_span
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint


def topic_type_conflict(architecture: Architecture) -> Iterator[Diagnostic]:
    """Several messages are named for one topic, service or action."""
    for topic in architecture.topics.values():
        users = _first_user_by_message((*topic.writers, *topic.readers))
        if len(users) > 1:
            # The finding is placed at the second user: the first one set the message, the second one deviates from it.
            first, second = list(users.values())[:2]
            labels = (
                Label(_message_span(user, architecture), f"`{user.message}` here, by the node `{user.node}`")
                for user in users.values()
                if user is not second
            )
            names = " and ".join(f"`{message}`" for message in users)
            yield Diagnostic(
                "topic-type-conflict",
                f"the {topic.flow} `{topic.name}` carries {names}",
                _message_span(second, architecture),
                labels=tuple(label for label in labels if label.span != NO_SPAN),
                help=f"give both nodes the same message, or one of them another {topic.flow}: `{first.node}` has "
                f"`{first.message}`, `{second.node}` `{second.message}`",
                element=second.node,
            )


def _first_user_by_message(endpoints: tuple[Endpoint, ...]) -> dict[str, Endpoint]:
    """Return the first endpoint that uses each message, by message, in the order of the endpoints."""
    users = dict[str, Endpoint]()
    for endpoint in endpoints:
        if endpoint.message is not None:
            users.setdefault(endpoint.message, endpoint)
    return users


def _message_span(endpoint: Endpoint, architecture: Architecture) -> Span:
    """Return the span where an endpoint's message was written, else its endpoint's, its port's or its node's."""
    port = architecture.outputs.get(endpoint.port or "") or architecture.inputs.get(endpoint.port or "")
    node = architecture.nodes.get(endpoint.node)
    return first_written_span(
        endpoint.message_at,
        endpoint.at,
        port.type_at if port else NO_SPAN,
        port.at if port else NO_SPAN,
        node.at if node else NO_SPAN,
    )


RULES = ((topic_type_conflict, Severity.ERROR),)
