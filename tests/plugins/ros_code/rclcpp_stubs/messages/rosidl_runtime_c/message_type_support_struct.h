// A stand-in for rosidl: see README.md.
#pragma once

struct rosidl_message_type_support_t
{
  const void * data;
  const rosidl_message_type_support_t * (* func)(
    const rosidl_message_type_support_t *, const char *);
};
