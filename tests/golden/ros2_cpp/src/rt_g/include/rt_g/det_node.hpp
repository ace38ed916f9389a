// Made by archgen from det.
// What the node does stands in det_behaviour.cpp.

#ifndef RT_G__DET_NODE_HPP_
#define RT_G__DET_NODE_HPP_

#include <atomic>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "rclcpp/rclcpp.hpp"
#include "rclcpp_action/rclcpp_action.hpp"
#include "rclcpp_lifecycle/lifecycle_node.hpp"
#include "sensor_msgs/msg/image.hpp"
#include "sensor_msgs/msg/point_cloud2.hpp"
#include "std_msgs/msg/string.hpp"
#include "std_srvs/srv/trigger.hpp"
#include "test_msgs/action/fibonacci.hpp"

namespace rt_g
{

class DetBehaviour;

/// Det.
class Det : public rclcpp_lifecycle::LifecycleNode
{
public:
  /// Declare the parameters.
  explicit Det(const rclcpp::NodeOptions & options = rclcpp::NodeOptions());

  ~Det() override;

  /// Publish g.det.found.
  void publish_found(const std_msgs::msg::String & message);

  /// Publish it, without a copy where its container has intra-process communication on.
  void publish_found(std_msgs::msg::String::UniquePtr message);

protected:
  /// Create what the node uses: until it is active, it hears and sends nothing.
  CallbackReturn on_configure(const rclcpp_lifecycle::State & state) override;

  /// Let it send, tell the own class, and let it hear.
  CallbackReturn on_activate(const rclcpp_lifecycle::State & state) override;

  /// Let it hear nothing more, tell the own class, and silence it.
  CallbackReturn on_deactivate(const rclcpp_lifecycle::State & state) override;

  /// Tell the own class, and take away what the node uses.
  CallbackReturn on_cleanup(const rclcpp_lifecycle::State & state) override;

  /// Tell the own class, and take away what the node uses.
  CallbackReturn on_shutdown(const rclcpp_lifecycle::State & state) override;

  /// Tell the own class, and take away what the node uses.
  CallbackReturn on_error(const rclcpp_lifecycle::State & state) override;

private:
  void create_interfaces();
  void destroy_interfaces();
  void silence(const rclcpp_lifecycle::State & state);
  std::string refuse(const std::string & port) const;
  void accept_go(
    std::shared_ptr<rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci>> goal);

  // Whether callbacks reach the own class, and whether what it sends goes out.
  std::atomic<bool> is_hearing_{false};
  std::atomic<bool> is_sending_{false};
  std::mutex mutex_;
  rclcpp::CallbackGroup::SharedPtr reentrant_group_;
  rclcpp_lifecycle::LifecyclePublisher<std_msgs::msg::String>::SharedPtr found_publisher_;
  std::unique_ptr<DetBehaviour> behaviour_;
  rclcpp::Subscription<sensor_msgs::msg::PointCloud2>::SharedPtr cloud_subscription_;
  rclcpp::Subscription<sensor_msgs::msg::Image>::SharedPtr image_subscription_;
  rclcpp::Service<std_srvs::srv::Trigger>::SharedPtr plan_service_;
  std::list<std::weak_ptr<rclcpp_action::ServerGoalHandle<test_msgs::action::Fibonacci>>>
  go_handles_;
  std::list<std::future<void>> go_goals_;
  rclcpp_action::Server<test_msgs::action::Fibonacci>::SharedPtr go_action_server_;
};

}  // namespace rt_g

#endif  // RT_G__DET_NODE_HPP_
