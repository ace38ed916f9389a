"""The interfaces of Player whose data components exchange: the message of data and that of commands, with their structs.

From libplayerinterface/interfaces/*.def of Player 3.1; where there are several, the first counts.
"""

from __future__ import annotations

from collections.abc import Mapping

_INTERFACES: Mapping[str, tuple[str, str]] = {
    "actarray": ("STATE actarray_data", "POS actarray_position_cmd"),
    "aio": ("STATE aio_data", "STATE aio_cmd"),
    "audio": ("WAV_REC audio_wav", "WAV_PLAY audio_wav"),
    "blinkenlight": ("STATE blinkenlight_data", "STATE blinkenlight_cmd"),
    "blobfinder": ("BLOBS blobfinder_data", ""),
    "bumper": ("STATE bumper_data", ""),
    "camera": ("STATE camera_data", ""),
    "dio": ("VALUES dio_data", "VALUES dio_cmd"),
    "fiducial": ("SCAN fiducial_data", ""),
    "gps": ("STATE gps_data", ""),
    "gripper": ("STATE gripper_data", ""),
    "health": ("STATE health_data", ""),
    "imu": ("STATE imu_data_state", ""),
    "ir": ("RANGES ir_data", ""),
    "joystick": ("STATE joystick_data", ""),
    "laser": ("SCAN laser_data", ""),
    "limb": ("STATE limb_data", "SETPOSE limb_setpose_cmd"),
    "localize": ("HYPOTHS localize_data", ""),
    "opaque": ("STATE opaque_data", "DATA opaque_data"),
    "planner": ("STATE planner_data", "GOAL planner_cmd"),
    "pointcloud3d": ("STATE pointcloud3d_data", ""),
    "position1d": ("STATE position1d_data", "VEL position1d_cmd_vel"),
    "position2d": ("STATE position2d_data", "VEL position2d_cmd_vel"),
    "position3d": ("STATE position3d_data", "SET_VEL position3d_cmd_vel"),
    "power": ("STATE power_data", ""),
    "ptz": ("STATE ptz_data", "STATE ptz_cmd"),
    "ranger": ("RANGE ranger_data_range", ""),
    "rfid": ("TAGS rfid_data", ""),
    "sonar": ("RANGES sonar_data", ""),
    "speech": ("", "SAY speech_cmd"),
    "speech_recognition": ("STRING speech_recognition_data", ""),
    "stereo": ("STATE stereo_data", ""),
    "wifi": ("STATE wifi_data", ""),
    "wsn": ("STATE wsn_data", "DEVSTATE wsn_cmd"),
}
OPAQUE = "opaque"


def record_interface(name: object) -> dict[str, str] | None:
    """Return the words that a driver needs for an interface; None for one that carries nothing, or that there is not.

    `data_struct` or `command_struct` is empty where it has no data, or no command with any.
    """
    if not isinstance(name, str) or name not in _INTERFACES:
        return None
    data, command = ([*each.split(), "", ""][:2] for each in _INTERFACES[name])
    prefix = f"PLAYER_{name.upper()}"
    return {
        "name": name,
        "code": f"{prefix}_CODE",
        "data": f"{prefix}_DATA_{data[0]}" if data[0] else "",
        "data_struct": f"player_{data[1]}_t" if data[0] else "",
        "command": f"{prefix}_CMD_{command[0]}" if command[0] else "",
        "command_struct": f"player_{command[1]}_t" if command[0] else "",
    }
