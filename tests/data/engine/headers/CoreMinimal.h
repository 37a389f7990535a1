// Stand-in for tests: the least of the engine's types that material code needs. Not engine code.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

using int32 = std::int32_t;
using uint8 = std::uint8_t;
using uint16 = std::uint16_t;
using uint32 = std::uint32_t;
using TCHAR = char16_t;

#define TEXT(Text) u##Text
#define INDEX_NONE (-1)
#define check(Expression) static_cast<void>(Expression)
#define ensure(Expression) static_cast<void>(Expression)

class FString
{
public:
	FString() = default;
	FString(const char* InText) : Text(InText) {}
	FString(const TCHAR* InText)
	{
		for (; *InText != 0; ++InText) Text += static_cast<char>(*InText);
	}

private:
	std::string Text;
};

class FText
{
public:
	static FText FromString(const FString& Text)
	{
		FText Result;
		Result.String = Text;
		return Result;
	}
	const FString& ToString() const { return String; }

private:
	FString String;
};

#define LOCTEXT(Key, Text) FText::FromString(FString(Text))

template <typename ElementType>
class TArray
{
public:
	TArray() = default;
	TArray(std::initializer_list<ElementType> InElements) : Elements(InElements) {}
	void Add(ElementType Element) { Elements.push_back(std::move(Element)); }
	void Reset() { Elements.clear(); }
	auto begin() const { return Elements.begin(); }
	auto end() const { return Elements.end(); }

private:
	std::vector<ElementType> Elements;
};

template <typename KeyType, typename ValueType>
struct TKeyValuePair
{
	KeyType Key;
	ValueType Value;
};

template <typename EnumType>
class TEnumAsByte
{
public:
	TEnumAsByte() = default;
	TEnumAsByte(EnumType InValue) : Value(static_cast<uint8>(InValue)) {}
	operator EnumType() const { return static_cast<EnumType>(Value); }

private:
	uint8 Value = 0;
};

struct FVector4
{
	float X, Y, Z, W;
};
