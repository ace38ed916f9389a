// A stand-in for GoogleTest: see README.md.
#ifndef GTEST__GTEST_H_
#define GTEST__GTEST_H_

#define EXPECT_EQ(first, second) static_cast<void>((first) == (second))
#define ASSERT_TRUE(value) static_cast<void>(static_cast<bool>(value))
#define TEST_F(Fixture, Name) \
  class Fixture ## Name : public Fixture \
  { \
    void TestBody() override; \
  }; \
  void Fixture ## Name::TestBody()

namespace testing
{

class Test
{
public:
  virtual ~Test() = default;

protected:
  virtual void SetUp() {}
  virtual void TearDown() {}
  virtual void TestBody() = 0;
};

}  // namespace testing

#endif  // GTEST__GTEST_H_
