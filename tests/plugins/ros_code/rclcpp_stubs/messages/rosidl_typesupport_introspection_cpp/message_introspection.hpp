// A stand-in for rosidl: see README.md.
#pragma once
#include <cstddef>
#include <cstdint>

#include "rosidl_runtime_c/message_type_support_struct.h"

namespace rosidl_typesupport_introspection_cpp
{

struct MessageMember
{
  const char * name_;
  std::uint8_t type_id_;
  std::size_t string_upper_bound_;
  const rosidl_message_type_support_t * members_;
  bool is_array_;
  std::size_t array_size_;
  bool is_upper_bound_;
  std::uint32_t offset_;
  void (* resize_function)(void *, std::size_t size);
};

struct MessageMembers
{
  const char * message_namespace_;
  const char * message_name_;
  std::uint32_t member_count_;
  const MessageMember * members_;
};

}  // namespace rosidl_typesupport_introspection_cpp
