#pragma once
#include <string>
#include <rtt/FlowStatus.hpp>
namespace RTT {
template<typename Signature> class SendHandle {};
template<typename Signature> class OperationCaller;
template<typename Result, typename... Arguments>
class OperationCaller<Result(Arguments...)> {
public:
  explicit OperationCaller(const std::string & name);
  Result operator()(Arguments... arguments);
  SendHandle<Result(Arguments...)> send(Arguments... arguments);
  bool ready() const;
};
}
