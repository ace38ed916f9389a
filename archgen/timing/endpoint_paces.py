"""How often something passes at an endpoint, as the analysis tells it."""

from __future__ import annotations

from archgen.model.node import Endpoint
from archgen.timing.analysis import Analysis, EventPace
from archgen.timing.system import activity_builder


def find_pace(analysis: Analysis, activity_names: activity_builder.ActivityNames, endpoint: Endpoint) -> EventPace:
    """Return how often something is published at an endpoint."""
    activity = activity_builder.activity_of_endpoint(activity_names, endpoint)
    return analysis.outputs.get((activity, activity_builder.endpoint_key(endpoint)), EventPace(None))
