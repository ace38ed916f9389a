// What Both does: written once by archgen, and yours since.

#ifndef RT_G__BOTH_BEHAVIOUR_HPP_
#define RT_G__BOTH_BEHAVIOUR_HPP_

#include "sensor_msgs/msg/image.hpp"

namespace rt_g
{

class Both;

/// Both.
class BothBehaviour
{
public:
  /// Remember the node: it publishes, calls, logs and knows its parameters.
  explicit BothBehaviour(Both & node);

  /// Take a message from image.
  void receive_image(sensor_msgs::msg::Image::ConstSharedPtr message);

  /// Do what is done every 0.02 s.
  void on_timer_fast();

  /// Do what is done every 0.5 s.
  void on_timer_slow();

private:
  Both & node_;
};

}  // namespace rt_g

#endif  // RT_G__BOTH_BEHAVIOUR_HPP_
