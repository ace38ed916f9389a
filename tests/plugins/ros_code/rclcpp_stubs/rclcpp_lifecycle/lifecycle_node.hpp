// A stand-in for rclcpp_lifecycle: see README.md.
#ifndef RCLCPP_LIFECYCLE__LIFECYCLE_NODE_HPP_
#define RCLCPP_LIFECYCLE__LIFECYCLE_NODE_HPP_

#include <memory>
#include <string>

#include "rclcpp/rclcpp.hpp"

namespace rclcpp_lifecycle
{

class State
{
};

template<typename Message>
class LifecyclePublisher : public rclcpp::Publisher<Message>
{
public:
  using SharedPtr = std::shared_ptr<LifecyclePublisher<Message>>;
};

class LifecycleNode : public rclcpp::NodeParts
{
public:
  enum class CallbackReturn { SUCCESS, FAILURE, ERROR };

  explicit LifecycleNode(
    const std::string & name, const rclcpp::NodeOptions & options = rclcpp::NodeOptions());
  LifecycleNode(
    const std::string & name, const std::string & space,
    const rclcpp::NodeOptions & options = rclcpp::NodeOptions());
  ~LifecycleNode() override;

  const State & configure();

  virtual CallbackReturn on_configure(const State & previous);
  virtual CallbackReturn on_activate(const State & previous);
  virtual CallbackReturn on_deactivate(const State & previous);
  virtual CallbackReturn on_error(const State & previous);
  virtual CallbackReturn on_cleanup(const State & previous);
  virtual CallbackReturn on_shutdown(const State & previous);

  template<typename Message>
  typename LifecyclePublisher<Message>::SharedPtr create_publisher(
    const std::string &, const rclcpp::QoS &)
  {
    return nullptr;
  }
};

}  // namespace rclcpp_lifecycle

#endif  // RCLCPP_LIFECYCLE__LIFECYCLE_NODE_HPP_
