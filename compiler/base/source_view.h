// One source line as it is drawn: tabs expanded, unprintable bytes replaced, clipped to a
// window, with the columns that bytes ended up in. Inside `base` only.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lobe {

/// Columns count from 0.
class SourceView {
public:
    /// `line` has to outlive the view.
    explicit SourceView(std::string_view line);

    /// The column in which the character at a byte of the line starts; past the end is the end.
    int column(std::size_t byte) const;
    int width() const { return columns_.back(); }

    /// The columns from `first` up to `last`. What is cut off shows as `...`, so the place of a
    /// column in the text that comes back is `column - shift(first)`.
    std::string window(int first, int last) const;
    static int shift(int first) { return first == 0 ? 0 : first - ellipsis; }

    static constexpr int ellipsis = 3;

private:
    std::string_view line_;
    std::vector<int> columns_;  ///< of each byte, and of the end
};

}  // namespace lobe
