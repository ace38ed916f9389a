// Made by archgen from motor.
// What the node does stands in motor_behaviour.cpp.

#ifndef RT_G__MOTOR_NODE_HPP_
#define RT_G__MOTOR_NODE_HPP_

#include <memory>

#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/string.hpp"
#include "rt_g/motor_parameters.hpp"

namespace rt_g
{

class MotorBehaviour;

/// Motor.
class Motor : public rclcpp::Node
{
public:
  /// Declare the parameters, and create what the node uses.
  explicit Motor(const rclcpp::NodeOptions & options = rclcpp::NodeOptions());

  ~Motor() override;

  /// Return the values that its parameters have now.
  motor_parameters::Params read_parameters() const;

  /// Publish motor.state.
  void publish_state(const std_msgs::msg::String & message);

  /// Publish it, without a copy where its container has intra-process communication on.
  void publish_state(std_msgs::msg::String::UniquePtr message);

private:
  void create_interfaces();

  std::unique_ptr<motor_parameters::ParamListener> parameter_listener_;
  PostSetParametersCallbackHandle::SharedPtr values_handle_;
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr state_publisher_;
  std::unique_ptr<MotorBehaviour> behaviour_;
  rclcpp::Subscription<std_msgs::msg::String>::SharedPtr target_subscription_;
};

}  // namespace rt_g

#endif  // RT_G__MOTOR_NODE_HPP_
