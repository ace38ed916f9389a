// Made by archgen from cam.

#include <memory>

#include "rt_g/cam_node.hpp"
#include "rclcpp/rclcpp.hpp"

int main(int argc, char * argv[])
{
  rclcpp::init(argc, argv);
  {
    auto node = std::make_shared<rt_g::Cam>();
    rclcpp::executors::SingleThreadedExecutor executor;
    executor.add_node(node->get_node_base_interface());
    executor.spin();
  }
  rclcpp::shutdown();
  return 0;
}
