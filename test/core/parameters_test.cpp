#include "fiimap/parameters.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "oracle.h"
#include "refusal.h"

namespace fiimap {
namespace {

TEST(NumberParameterTest, AcceptsItsRangeWithBothEnds) {
  double field = 0.0;
  const Parameter parameter = numberParameter("gain", &field, -0.25, 1.5, "m", "test");
  for (const auto& [text, value] : std::map<std::string, double>{
           {"-0.25", -0.25}, {"1.5", 1.5}, {"0", 0.0}, {"1e-3", 0.001}, {"+0.5", 0.5}}) {
    EXPECT_EQ(refusal(parameter, text), "");
    EXPECT_DOUBLE_EQ(field, value);
  }
}

TEST(NumberParameterTest, RefusesBelowAndAboveItsRange) {
  double field = 0.5;
  const Parameter parameter = numberParameter("gain", &field, -0.25, 1.5, "m", "test");
  for (const char* text : {"-0.2500001", "1.5000001", "1e999", "-1e999", "1e300"}) {
    const std::string message = refusal(parameter, text);
    EXPECT_TRUE(contains(message, "gain")) << message;
    EXPECT_TRUE(contains(message, text)) << message;
    EXPECT_TRUE(contains(message, "-0.25") && contains(message, "1.5")) << message;
    EXPECT_EQ(field, 0.5) << "changed by " << text;
  }
}

TEST(NumberParameterTest, RefusesWhatIsNoFiniteNumber) {
  double field = 0.5;
  const Parameter parameter = numberParameter("gain", &field, -1e6, 1e6, "", "test");
  for (const char* text :
       {"", " ", "abc", "1.0m", "0.5 0.6", "0,5", "nan", "inf", "-inf", "true"}) {
    EXPECT_NE(refusal(parameter, text), "") << "'" << text << "'";
    EXPECT_EQ(field, 0.5);
  }
}

TEST(NumberParameterTest, TextOfItsValueGivesItsValueBack) {
  test::Random random(21);
  double field = 0.0;
  const Parameter parameter = numberParameter("gain", &field, -1e9, 1e9, "", "test");
  for (int round = 0; round < 500; ++round) {
    const double value =
        test::uniformReal(random, -1.0, 1.0) * std::pow(10.0, test::uniformInt(random, -6, 8));
    field = value;
    parameter.set(parameter.get());
    ASSERT_EQ(field, value) << "seed 21";
  }
}

TEST(IntegerParameterTest, AcceptsItsRangeWithBothEnds) {
  int field = 0;
  const Parameter parameter = integerParameter("steps", &field, -3, 12, "", "test");
  for (const auto& [text, value] : std::map<std::string, int>{{"-3", -3}, {"0", 0}, {"12", 12}}) {
    EXPECT_EQ(refusal(parameter, text), "");
    EXPECT_EQ(field, value);
  }
}

TEST(IntegerParameterTest, RefusesOtherNumbersAndText) {
  int field = 5;
  const Parameter parameter = integerParameter("steps", &field, -3, 12, "", "test");
  for (const char* text : {"-4", "13", "2.5", "99999999999", "-99999999999", "", "two", "nan"}) {
    const std::string message = refusal(parameter, text);
    EXPECT_TRUE(contains(message, "steps")) << text;
    EXPECT_TRUE(contains(message, text)) << message;
    EXPECT_TRUE(contains(message, "-3") && contains(message, "12")) << message;
    EXPECT_EQ(field, 5);
  }
}

TEST(FlagParameterTest, IsTrueOrFalse) {
  bool field = false;
  const Parameter parameter = flagParameter("walls", &field, "test");
  parameter.set("true");
  EXPECT_TRUE(field);
  EXPECT_EQ(parameter.get(), "true");
  parameter.set("false");
  EXPECT_FALSE(field);
  EXPECT_EQ(parameter.get(), "false");
  for (const char* text : {"", "maybe", "2", "truefalse"}) {
    EXPECT_TRUE(contains(refusal(parameter, text), "walls")) << text;
    EXPECT_FALSE(field);
  }
}

TEST(TextParameterTest, TakesAnyText) {
  std::string field;
  const Parameter parameter = textParameter("frame", &field, "test");
  for (const char* text : {"world", "", "a b", "/tf"}) {
    parameter.set(text);
    EXPECT_EQ(field, text);
    EXPECT_EQ(parameter.get(), text);
  }
}

enum class Fruit { kApple, kPear, kPlum };

TEST(ChoiceParameterTest, TakesEachNameAndNoOther) {
  Fruit field = Fruit::kApple;
  const Parameter parameter = choiceParameter("fruit", &field, {"apple", "pear", "plum"}, "test");
  parameter.set("plum");
  EXPECT_EQ(field, Fruit::kPlum);
  EXPECT_EQ(parameter.get(), "plum");
  parameter.set("pear");
  EXPECT_EQ(field, Fruit::kPear);
  for (const char* text : {"", "Pear", "1", "cherry", "app"}) {
    const std::string message = refusal(parameter, text);
    for (const char* part : {"fruit", text, "apple", "pear", "plum"}) {
      EXPECT_TRUE(contains(message, part)) << message;
    }
    EXPECT_EQ(field, Fruit::kPear);
  }
}

TEST(ApplyParametersTest, SetsWhatIsThereAndReturnsWhatNobodyKnows) {
  double gain = 1.0, offset = 7.0;
  int steps = 1;
  const std::vector<Parameter> parameters = {numberParameter("gain", &gain, 0.0, 10.0, "", ""),
                                             numberParameter("offset", &offset, 0.0, 10.0, "", ""),
                                             integerParameter("steps", &steps, 0, 10, "", "")};
  const std::vector<std::string> unknown =
      applyParameters({{"gain", "2.5"}, {"stesp", "3"}, {"steps", "4"}, {"z", ""}}, parameters);
  EXPECT_EQ(gain, 2.5);
  EXPECT_EQ(offset, 7.0);
  EXPECT_EQ(steps, 4);
  EXPECT_EQ(unknown, (std::vector<std::string>{"stesp", "z"}));
}

TEST(ApplyParametersTest, ThrowsOnABadValue) {
  double gain = 1.0;
  const std::vector<Parameter> parameters = {numberParameter("gain", &gain, 0.0, 10.0, "", "")};
  EXPECT_THROW(applyParameters({{"gain", "11"}}, parameters), std::invalid_argument);
  EXPECT_THROW(applyParameters({{"gain", "fast"}}, parameters), std::invalid_argument);
  EXPECT_EQ(gain, 1.0);
}

}  // namespace
}  // namespace fiimap
