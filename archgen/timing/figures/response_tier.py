"""The ways in which a response time is found."""

from __future__ import annotations

from typing import Literal

ResponseTier = Literal[
    "declared",
    "dedicated",
    "host",
    "fair",
    "non_preemptive",
    "fifo",
    "ros2_executor",
    "edf",
    "priorities",
    "executor",
    "cores",
    "whole host",
    "whole way",
    "unknown",
]
"""How a response time was found (docs/timing.md, "Response times"): `declared`; `dedicated`, assuming a core
of its own; `host`, any work-conserving scheduler of one core; `priorities`, fixed ones; `fair`, threads that Linux
shares the cores among; `executor`, single-threaded; `cores`, several; `whole host`, several taken as one; `whole way`,
over hosts and links; the words of an order (`non_preemptive`, `fifo`,
`edf`, `ros2_executor`): one thread or core that keeps to it.
"""
