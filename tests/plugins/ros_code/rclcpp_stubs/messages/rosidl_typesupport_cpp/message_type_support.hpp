// A stand-in for rosidl: see README.md.
#pragma once
#include "rosidl_runtime_c/message_type_support_struct.h"

namespace rosidl_typesupport_cpp
{

template<typename Message>
const rosidl_message_type_support_t * get_message_type_support_handle();

}  // namespace rosidl_typesupport_cpp
