// What User does: written once by archgen, and yours since.

#ifndef RT_G__USER_BEHAVIOUR_HPP_
#define RT_G__USER_BEHAVIOUR_HPP_

namespace people
{

class Asker;

/// Ends in "quotes".
class AskerBehaviour
{
public:
  /// Remember the node: it publishes, calls, logs and knows its parameters.
  explicit AskerBehaviour(Asker & node);

private:
  Asker & node_;
};

}  // namespace people

#endif  // RT_G__USER_BEHAVIOUR_HPP_
