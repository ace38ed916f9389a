// A stand-in for rosidl: see README.md.
#pragma once

namespace rosidl_typesupport_introspection_cpp
{

extern const char * typesupport_identifier;

}  // namespace rosidl_typesupport_introspection_cpp
