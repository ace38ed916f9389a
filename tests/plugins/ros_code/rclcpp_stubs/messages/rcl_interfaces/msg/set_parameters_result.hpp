// A stand-in for rcl_interfaces: see README.md.
#ifndef RCL_INTERFACES__MSG__SET_PARAMETERS_RESULT_HPP_
#define RCL_INTERFACES__MSG__SET_PARAMETERS_RESULT_HPP_

#include <string>

namespace rcl_interfaces::msg
{

struct SetParametersResult
{
  bool successful;
  std::string reason;
};

}  // namespace rcl_interfaces::msg

#endif  // RCL_INTERFACES__MSG__SET_PARAMETERS_RESULT_HPP_
