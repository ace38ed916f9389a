// Made by archgen from cam.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "rt_g/cam_behaviour.hpp"
#include "rt_g/cam_node.hpp"
#include "rclcpp/rclcpp.hpp"

/// The node has what the architecture says of it.
class CamTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    rclcpp::init(0, nullptr);
    rclcpp::NodeOptions options;
    node_ = std::make_shared<rt_g::Cam>(options);
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

  std::shared_ptr<rt_g::Cam> node_;
};

TEST_F(CamTest, Starts)
{
  EXPECT_EQ(node_->get_name(), std::string("cam"));
}

TEST_F(CamTest, Publishes)
{
  const auto node_topics = node_->get_node_topics_interface();
  std::set<std::string> names;
  // g.cam.cloud
  names.insert(node_topics->resolve_topic_name("cloud"));
  // g.cam.image
  names.insert(node_topics->resolve_topic_name("image"));
  const auto missing = wait_for(
    names, [this]() {
      return node_->get_node_graph_interface()->get_publisher_names_and_types_by_node(
        node_->get_name(), node_->get_namespace());
    });
  EXPECT_EQ(missing, std::set<std::string>());
}

TEST_F(CamTest, HasItsParameters)
{
  ASSERT_TRUE(node_->has_parameter("greeting"));
  EXPECT_EQ(
    node_->get_parameter("greeting").get_value<std::string>(),
    std::string("say \"hello\""));
  ASSERT_TRUE(node_->has_parameter("lens.class"));
  EXPECT_EQ(
    node_->get_parameter("lens.class").get_value<std::int64_t>(),
    std::int64_t{3});
  ASSERT_TRUE(node_->has_parameter("lens.focus"));
  EXPECT_EQ(
    node_->get_parameter("lens.focus").get_value<double>(),
    0.5);
  ASSERT_TRUE(node_->has_parameter("map_file"));
  ASSERT_TRUE(node_->has_parameter("mode"));
  EXPECT_EQ(
    node_->get_parameter("mode").get_value<std::string>(),
    std::string("careful"));
  ASSERT_TRUE(node_->has_parameter("names"));
  EXPECT_EQ(
    node_->get_parameter("names").get_value<std::vector<std::string>>(),
    (std::vector<std::string>{"a", "b'c"}));
  ASSERT_TRUE(node_->has_parameter("rate"));
  EXPECT_EQ(
    node_->get_parameter("rate").get_value<double>(),
    10.0);
  ASSERT_TRUE(node_->has_parameter("size"));
  EXPECT_EQ(
    node_->get_parameter("size").get_value<std::int64_t>(),
    std::int64_t{640});
}
