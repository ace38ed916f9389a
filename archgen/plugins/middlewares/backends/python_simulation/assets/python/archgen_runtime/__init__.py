"""Run an architecture in logical time, without middleware: the same inputs give the same trace.

Made by archgen.
"""

from .assembly import Assembly
from .command import run_command
from .component import Component
from .errors import SimulationError
from .parameters import check_choice, check_range
from .ports import Client, InPort, OutPort, Server
from .scenario import apply_scenario, read_time
from .simulation import Simulation
from .timing import Timing
from .values import Message, anything, items, number, record, text, truth, whole, write_value

__all__ = [
    "Assembly",
    "Client",
    "Component",
    "InPort",
    "Message",
    "OutPort",
    "Server",
    "Simulation",
    "SimulationError",
    "Timing",
    "anything",
    "apply_scenario",
    "check_choice",
    "check_range",
    "items",
    "number",
    "read_time",
    "record",
    "run_command",
    "text",
    "truth",
    "whole",
    "write_value",
]
