// One to four numbers in a row: what a material's values have. A scene may have millions, so they
// need no memory of their own.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace lobe::scene {

class Components {
public:
    static constexpr std::size_t most = 4;

    Components() = default;
    Components(std::initializer_list<double> numbers)
    {
        for (const double number : numbers) push_back(number);
    }
    Components(std::size_t count, double number) { resize(count, number); }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    double& operator[](std::size_t component) { return numbers_[component]; }
    double operator[](std::size_t component) const { return numbers_[component]; }
    double* begin() { return numbers_.data(); }
    double* end() { return numbers_.data() + size_; }
    const double* begin() const { return numbers_.data(); }
    const double* end() const { return numbers_.data() + size_; }

    void push_back(double number)
    {
        assert(size_ < most);
        numbers_[size_++] = number;
    }
    void resize(std::size_t count, double number = 0)
    {
        assert(count <= most);
        while (size_ < count) push_back(number);
        size_ = static_cast<std::uint8_t>(count);
    }

    friend bool operator==(const Components& a, std::span<const double> b)
    {
        return std::ranges::equal(a, b);
    }
    friend bool operator==(const Components& a, const Components& b)
    {
        return std::ranges::equal(a, b);
    }

private:
    std::array<double, most> numbers_{};
    std::uint8_t size_ = 0;
};

}  // namespace lobe::scene
