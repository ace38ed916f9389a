// What Camera does: written once by archgen, and yours since.

#include "rt_g/cam_behaviour.hpp"

#include "rt_g/cam_node.hpp"

namespace rt_g
{

CamBehaviour::CamBehaviour(Cam & node)
: node_(node)
{
  RCLCPP_DEBUG(node_.get_logger(), "ready");
}

void CamBehaviour::on_timer()
{
}

}  // namespace rt_g
