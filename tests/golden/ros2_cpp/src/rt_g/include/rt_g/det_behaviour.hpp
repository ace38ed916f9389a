// What Det does: written once by archgen, and yours since.

#ifndef RT_G__DET_BEHAVIOUR_HPP_
#define RT_G__DET_BEHAVIOUR_HPP_

#include <memory>

#include "rclcpp_action/rclcpp_action.hpp"
#include "sensor_msgs/msg/image.hpp"
#include "sensor_msgs/msg/point_cloud2.hpp"
#include "std_srvs/srv/trigger.hpp"
#include "test_msgs/action/fibonacci.hpp"

namespace rt_g
{

class Det;

/// Det.
class DetBehaviour
{
public:
  /// Remember the node: it publishes, calls, logs and knows its parameters.
  explicit DetBehaviour(Det & node);

  /// Begin: it may send now, and hears from then on. Return false to stay inactive.
  bool on_activate();

  /// End: it hears nothing more, and what it sends here is the last that goes out.
  void on_deactivate();

  /// Take a message from cloud.
  void receive_cloud(sensor_msgs::msg::PointCloud2::ConstSharedPtr message);

  /// Take a message from image.
  void receive_image(sensor_msgs::msg::Image::ConstSharedPtr message);

  /// Answer a request to plan.
  void serve_plan(
    const std_srvs::srv::Trigger::Request & request,
    std_srvs::srv::Trigger::Response & response);

  /// Carry out a goal of go.
  /// It has a thread of its own. End early where goal->is_executing() or rclcpp::ok() is false.
  void execute_go(
    std::shared_ptr<rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci>> goal);

private:
  Det & node_;
};

}  // namespace rt_g

#endif  // RT_G__DET_BEHAVIOUR_HPP_
