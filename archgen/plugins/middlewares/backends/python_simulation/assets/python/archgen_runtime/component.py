"""Components: ports, and what is done when they are active."""

from .errors import SimulationError
from .ports import Client, InPort, OutPort, Server
from .timing import Activation


class Component:
    """A component. Its class has a method `fire`."""

    def __init__(self, component_id, timing):
        """Take the id in the model, and when it is active."""
        self.id = component_id
        self.timing = timing
        self.inputs = []
        self.outputs = []
        self.clients = []
        self.activation = None
        self._simulation = None

    def fire(self):
        """Do what is done when it is active."""
        raise NotImplementedError

    @property
    def now_ns(self):
        """The time of the run: nanoseconds since the start."""
        return self.simulation.now_ns

    @property
    def simulation(self):
        """The run that it takes part in."""
        if self._simulation is None:
            raise SimulationError(f"{self.id} does something before the run begins")
        return self._simulation

    def join(self, simulation):
        """Take part in a run."""
        self._simulation = simulation
        self.activation = Activation(self.timing, self.inputs)

    def make_input(self, name, declared):
        """Declare an input, and return it."""
        self.inputs.append(InPort(self, name, declared.metadata["kind"]))
        return self.inputs[-1]

    def make_output(self, name, declared):
        """Declare an output, and return it."""
        self.outputs.append(OutPort(self, name, declared.metadata["kind"]))
        return self.outputs[-1]

    def make_server(self, name, handler):
        """Declare what others may call, and return it."""
        return Server(self, name, handler)

    def make_client(self, name):
        """Declare what it calls, and return it."""
        self.clients.append(Client(self, name))
        return self.clients[-1]
