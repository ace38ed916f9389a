// What Motor does: written once by archgen, and yours since.

#ifndef RT_G__MOTOR_BEHAVIOUR_HPP_
#define RT_G__MOTOR_BEHAVIOUR_HPP_

#include "std_msgs/msg/string.hpp"

namespace rt_g
{

class Motor;

/// Motor.
class MotorBehaviour
{
public:
  /// Remember the node: it publishes, calls, logs and knows its parameters.
  explicit MotorBehaviour(Motor & node);

  /// Take a message from target.
  void receive_target(std_msgs::msg::String::ConstSharedPtr message);

private:
  Motor & node_;
};

}  // namespace rt_g

#endif  // RT_G__MOTOR_BEHAVIOUR_HPP_
