// Made by archgen from both.

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "rt_g/both_behaviour.hpp"
#include "rt_g/both_node.hpp"
#include "rclcpp/rclcpp.hpp"

/// The node has what the architecture says of it.
class BothTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    rclcpp::init(0, nullptr);
    rclcpp::NodeOptions options;
    node_ = std::make_shared<rt_g::Both>(options);
  }

  void TearDown() override
  {
    node_.reset();
    rclcpp::shutdown();
  }

  /// Return the names that are not there after a minute: the graph learns of them late.
  template<typename Reader>
  static std::set<std::string> wait_for(std::set<std::string> missing, const Reader & read_names)
  {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!missing.empty() && std::chrono::steady_clock::now() < end) {
      for (const auto & known : read_names()) {
        missing.erase(known.first);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return missing;
  }

  std::shared_ptr<rt_g::Both> node_;
};

TEST_F(BothTest, Starts)
{
  EXPECT_EQ(node_->get_name(), std::string("both"));
}

TEST_F(BothTest, Subscribes)
{
  const auto node_topics = node_->get_node_topics_interface();
  std::set<std::string> names;
  // g.slow.image
  names.insert(node_topics->resolve_topic_name("image"));
  const auto missing = wait_for(
    names, [this]() {
      return node_->get_node_graph_interface()->get_subscriber_names_and_types_by_node(
        node_->get_name(), node_->get_namespace());
    });
  EXPECT_EQ(missing, std::set<std::string>());
}

TEST_F(BothTest, Calls)
{
  const auto node_services = node_->get_node_services_interface();
  std::set<std::string> names;
  // g.fast.plan
  names.insert(node_services->resolve_service_name("plan"));
  const auto missing = wait_for(
    names, [this]() {
      return node_->get_node_graph_interface()->get_client_names_and_types_by_node(
        node_->get_name(), node_->get_namespace());
    });
  EXPECT_EQ(missing, std::set<std::string>());
}
