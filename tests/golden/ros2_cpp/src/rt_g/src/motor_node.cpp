// Made by archgen from motor.

#include "rt_g/motor_node.hpp"

#include <memory>
#include <utility>
#include <vector>

#include "rt_g/motor_behaviour.hpp"

namespace rt_g
{

namespace
{

/// Tell the own class of new values, where it has a method for them.
template<typename Own>
auto tell_values(Own & own, const std::vector<rclcpp::Parameter> & values, int)
-> decltype(own.on_parameters(values))
{
  return own.on_parameters(values);
}

template<typename Own>
void tell_values(Own &, const std::vector<rclcpp::Parameter> &, ...)
{
}

}  // namespace

Motor::Motor(const rclcpp::NodeOptions & options)
: rclcpp::Node("motor", options)
{
  parameter_listener_ = std::make_unique<motor_parameters::ParamListener>(
    get_node_parameters_interface(), get_logger());
  values_handle_ = add_post_set_parameters_callback(
    [this](const std::vector<rclcpp::Parameter> & values) {
      if (behaviour_) {
        tell_values(*behaviour_, values, 0);
      }
    });
  create_interfaces();
  behaviour_ = std::make_unique<MotorBehaviour>(*this);
}

Motor::~Motor() = default;

motor_parameters::Params Motor::read_parameters() const
{
  return parameter_listener_->get_params();
}

void Motor::create_interfaces()
{
  // motor.state
  state_publisher_ = create_publisher<std_msgs::msg::String>(
    "state",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile());
  // motor.target
  target_subscription_ = create_subscription<std_msgs::msg::String>(
    "target",
    rclcpp::QoS(rclcpp::KeepLast(10))
    .reliable()
    .durability_volatile(),
    [this](std_msgs::msg::String::ConstSharedPtr message) {
      behaviour_->receive_target(std::move(message));
    });
}

void Motor::publish_state(const std_msgs::msg::String & message)
{
  state_publisher_->publish(message);
}

void Motor::publish_state(std_msgs::msg::String::UniquePtr message)
{
  state_publisher_->publish(std::move(message));
}

}  // namespace rt_g
