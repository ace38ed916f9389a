// A stand-in for rclcpp_components: see README.md.
#ifndef RCLCPP_COMPONENTS__REGISTER_NODE_MACRO_HPP_
#define RCLCPP_COMPONENTS__REGISTER_NODE_MACRO_HPP_

#include <type_traits>

#include "rclcpp/rclcpp.hpp"

#define RCLCPP_COMPONENTS_REGISTER_NODE(Class) \
  static_assert(std::is_constructible_v<Class, const rclcpp::NodeOptions &>, "no component");

#endif  // RCLCPP_COMPONENTS__REGISTER_NODE_MACRO_HPP_
