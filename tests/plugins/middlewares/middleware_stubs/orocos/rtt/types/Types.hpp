#pragma once
#include <memory>
namespace RTT { namespace types {
class TypeInfoGenerator { public: virtual ~TypeInfoGenerator(); };
class TypeInfoRepository {
public:
  using shared_ptr = std::shared_ptr<TypeInfoRepository>;
  bool addType(TypeInfoGenerator * generator);
};
TypeInfoRepository::shared_ptr Types();
} }
