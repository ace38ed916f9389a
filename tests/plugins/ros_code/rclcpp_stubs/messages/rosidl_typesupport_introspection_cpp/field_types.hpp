// A stand-in for rosidl: see README.md.
#pragma once
#include <cstdint>

namespace rosidl_typesupport_introspection_cpp
{

const std::uint8_t ROS_TYPE_FLOAT = 1;
const std::uint8_t ROS_TYPE_DOUBLE = 2;
const std::uint8_t ROS_TYPE_LONG_DOUBLE = 3;
const std::uint8_t ROS_TYPE_CHAR = 4;
const std::uint8_t ROS_TYPE_WCHAR = 5;
const std::uint8_t ROS_TYPE_BOOLEAN = 6;
const std::uint8_t ROS_TYPE_OCTET = 7;
const std::uint8_t ROS_TYPE_UINT8 = 8;
const std::uint8_t ROS_TYPE_INT8 = 9;
const std::uint8_t ROS_TYPE_UINT16 = 10;
const std::uint8_t ROS_TYPE_INT16 = 11;
const std::uint8_t ROS_TYPE_UINT32 = 12;
const std::uint8_t ROS_TYPE_INT32 = 13;
const std::uint8_t ROS_TYPE_UINT64 = 14;
const std::uint8_t ROS_TYPE_INT64 = 15;
const std::uint8_t ROS_TYPE_STRING = 16;
const std::uint8_t ROS_TYPE_WSTRING = 17;
const std::uint8_t ROS_TYPE_MESSAGE = 18;

}  // namespace rosidl_typesupport_introspection_cpp
