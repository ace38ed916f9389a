// A stand-in for rcl_interfaces: see README.md.
#ifndef RCL_INTERFACES__MSG__PARAMETER_DESCRIPTOR_HPP_
#define RCL_INTERFACES__MSG__PARAMETER_DESCRIPTOR_HPP_

#include <cstdint>
#include <string>
#include <vector>

namespace rcl_interfaces::msg
{

struct FloatingPointRange
{
  double from_value;
  double to_value;
  double step;
};

struct IntegerRange
{
  std::int64_t from_value;
  std::int64_t to_value;
  std::uint64_t step;
};

struct ParameterDescriptor
{
  std::string description;
  std::string additional_constraints;
  bool read_only;
  std::vector<FloatingPointRange> floating_point_range;
  std::vector<IntegerRange> integer_range;
};

}  // namespace rcl_interfaces::msg

#endif  // RCL_INTERFACES__MSG__PARAMETER_DESCRIPTOR_HPP_
