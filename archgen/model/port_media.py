"""What a port is: over ROS, over something else between programs, or physical. Every stage asks here, and nowhere else."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Mapping

    from archgen.model.component import Input, Output
    from archgen.model.message_types import ConceptualType
    from archgen.model.node import Endpoint, Topic

PortNature = Literal["ros", "physical", "other"]
"""`other`: data between programs that does not travel over ROS, so that it has neither topic nor message of ROS."""
PortFlow = Literal["topic", "service", "action"]
"""Whether data is sent, or something is called."""

ROS, PHYSICAL, DIGITAL, MEMORY = "ros", "physical", "digital", "memory"

MEDIUM_NAMES: Mapping[str, str] = {
    "ros": "ROS",
    "physical": "physical",
    "memory": "memory",
    "file": "file",
    "database": "database",
    "amqp": "AMQP",
    "bluetooth": "Bluetooth",
    "can": "CAN",
    "canopen": "CANopen",
    "coap": "CoAP",
    "dds": "DDS",
    "ethercat": "EtherCAT",
    "ethernet": "Ethernet",
    "flexray": "FlexRay",
    "grpc": "gRPC",
    "http": "HTTP",
    "https": "HTTPS",
    "i2c": "I2C",
    "lin": "LIN",
    "lora": "LoRa",
    "mavlink": "MAVLink",
    "modbus": "Modbus",
    "mqtt": "MQTT",
    "opcua": "OPC UA",
    "orocos": "Orocos",
    "profibus": "PROFIBUS",
    "profinet": "PROFINET",
    "rest": "REST",
    "rpc": "RPC",
    "rs485": "RS-485",
    "rtsp": "RTSP",
    "serial": "serial",
    "someip": "SOME/IP",
    "spi": "SPI",
    "tcp": "TCP",
    "uart": "UART",
    "udp": "UDP",
    "usb": "USB",
    "webrtc": "WebRTC",
    "websocket": "WebSocket",
    "yarp": "YARP",
    "zenoh": "Zenoh",
    "zeromq": "ZeroMQ",
}
"""The words that archgen knows, as they are written in running text. Any other word is accepted, too."""

_STORES: Mapping[str, str] = {MEMORY: "in memory", "file": "in a file", "database": "in a database"}
"""Where data lies that is put somewhere instead of being sent over something."""


def nature_of(port: Input | Output) -> PortNature:
    """Return what a port is."""
    if port.medium == ROS:
        return "ros"
    return "physical" if port.medium == PHYSICAL else "other"


def uses_ros(port: Input | Output) -> bool:
    """Whether a port has a topic, service or action of ROS, and a message."""
    return port.medium == ROS


def is_physical(port: Input | Output) -> bool:
    """Whether what passes a port is no data at all."""
    return port.medium == PHYSICAL


def normalise_medium(text: str | None) -> str | None:
    """Return a word as it is compared: capitals do not count. `digital` says nothing of the way, as nothing does: None."""
    word = text.strip().lower() if text else None
    return None if word == DIGITAL else word or None


def word_of_medium(carrier: Input | Output | Topic) -> str:
    """Return the word by which lists, selectors and other programs name a medium: `digital` where it is ROS."""
    return DIGITAL if carrier.medium == ROS else carrier.medium


def list_medium_words(port: Input | Output) -> tuple[str, ...]:
    """Return the words by which selectors find a port: what is not physical is `digital`, and its own word, too."""
    return (port.medium,) if port.medium == PHYSICAL else (DIGITAL, port.medium)


def name_medium(word: str) -> str:
    """Return a medium as it stands in running text: `MQTT` for `mqtt`, a word of the project's own as it is."""
    return MEDIUM_NAMES.get(word, word)


def label_of_medium(carrier: Input | Output | Topic | Endpoint) -> str:
    """Return what pictures and tables add to a port or topic: how its medium is called, nothing where it is ROS."""
    return "" if carrier.medium == ROS else name_medium(carrier.medium)


def key_of_carrier(endpoint: Endpoint) -> str:
    """Return the key of what an endpoint uses, in the architecture's topics or channels: a call has a key of its own."""
    return make_channel_key(endpoint.label, endpoint.flow) if endpoint.medium != ROS else endpoint.label


def make_channel_key(name: str, flow: PortFlow) -> str:
    """Return the key of a channel: the same name may be sent to and called."""
    return name if flow == "topic" else f"{name} ({flow})"


def label_of_carrier(carrier: Topic | Endpoint) -> str:
    """Return how people call a topic or channel: its name in ROS, else what is written of it with its medium in brackets."""
    return carrier.label if carrier.medium == ROS else f"{name_on_medium(carrier)} ({name_medium(carrier.medium)})"


def key_of_channel(carrier: Topic | Endpoint) -> str:
    """Return the key of a channel, or of what an endpoint uses, among the architecture's channels."""
    return make_channel_key(carrier.label, carrier.flow)


def name_on_medium(carrier: Topic | Endpoint) -> str:
    """Return the name of a topic or channel without the word of its medium."""
    return carrier.label if carrier.medium == ROS else carrier.label.removeprefix(f"{carrier.medium} ")


def describe_carried(port: Input | Output) -> str:
    """Return in words what passes a port: a message of ROS, a physical quantity, or data and the way it takes."""
    if port.medium == ROS:
        return "a message"
    if port.medium == PHYSICAL:
        return "a physical quantity"
    return f"data {describe_way(port.medium)}"


def describe_way(medium: str) -> str:
    """Return in words how data goes that is no ROS: over a medium, or by being put somewhere."""
    return _STORES.get(medium) or f"over {name_medium(medium)}"


def flow_of_port(port: Input | Output, carried_type: ConceptualType | None) -> PortFlow:
    """Return whether a port's data is sent or called for. What is no ROS is called if its type says what is asked and answered."""
    if carried_type is None or port.medium == PHYSICAL:
        return "topic"
    middle = (carried_type.message or "").split("/")[1:2]
    if middle in (["srv"], ["action"]):
        return "service" if middle == ["srv"] else "action"
    if port.medium != ROS and carried_type.feedback:
        return "action"
    return "service" if port.medium != ROS and (carried_type.request or carried_type.response) else "topic"
