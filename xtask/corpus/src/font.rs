//! Letters of three by five pixels for contact sheets.

/// Width and height of a cell in pixels, with a column and a row between letters.
pub const CELL_PX: [usize; 2] = [4, 6];

/// Glyphs: a character, and five octal digits, one for each row from the top, whose bits are pixels from the left.
const GLYPHS: [(char, &str); 49] = [
    ('A', "25755"),
    ('B', "65656"),
    ('C', "34443"),
    ('D', "65556"),
    ('E', "74647"),
    ('F', "74644"),
    ('G', "34553"),
    ('H', "55755"),
    ('I', "72227"),
    ('J', "11152"),
    ('K', "55655"),
    ('L', "44447"),
    ('M', "57755"),
    ('N', "65555"),
    ('O', "25552"),
    ('P', "65644"),
    ('Q', "25563"),
    ('R', "65655"),
    ('S', "34216"),
    ('T', "72222"),
    ('U', "55557"),
    ('V', "55552"),
    ('W', "55775"),
    ('X', "55255"),
    ('Y', "55222"),
    ('Z', "71247"),
    ('0', "75557"),
    ('1', "26227"),
    ('2', "61247"),
    ('3', "61216"),
    ('4', "55711"),
    ('5', "74616"),
    ('6', "34757"),
    ('7', "71122"),
    ('8', "75757"),
    ('9', "75716"),
    (' ', "00000"),
    ('.', "00002"),
    (',', "00024"),
    (':', "02020"),
    ('-', "00700"),
    ('_', "00007"),
    ('+', "02720"),
    ('/', "11244"),
    ('(', "12221"),
    (')', "42224"),
    ('[', "64446"),
    (']', "31113"),
    ('?', "71202"),
];

/// Returns the pixels of a text, each as column and row. Letters are capitals; unknown characters are question marks.
pub fn pixels(text: &str) -> impl Iterator<Item = [usize; 2]> + '_ {
    text.chars().enumerate().flat_map(|(at, character)| {
        let rows = rows(character.to_ascii_uppercase());
        (0..15).filter_map(move |pixel| {
            let (column, row) = (pixel % 3, pixel / 3);
            (rows[row] >> (2 - column) & 1 == 1).then_some([at * CELL_PX[0] + column, row])
        })
    })
}

fn rows(character: char) -> [u8; 5] {
    let of = |character| GLYPHS.iter().find(|(known, _)| *known == character);
    let digits = of(character).or(of('?')).map_or("00000", |(_, digits)| digits).as_bytes();
    std::array::from_fn(|row| digits[row] - b'0')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_drawn_from_the_left_and_the_top() {
        let mut drawn = [[' '; 7]; 5];
        pixels("l7").for_each(|[x, y]| drawn[y][x] = '#');
        let rows = drawn.map(|row| row.iter().collect::<String>());
        assert_eq!(rows, ["#   ###", "#     #", "#     #", "#    # ", "###  # "]);
    }

    #[test]
    fn glyphs_differ_and_have_five_octal_digits() {
        for (at, (character, digits)) in GLYPHS.iter().enumerate() {
            assert!(digits.len() == 5 && digits.bytes().all(|digit| (b'0'..b'8').contains(&digit)), "{character}");
            assert!(GLYPHS[..at].iter().all(|(_, other)| other != digits), "{character}");
        }
        assert!(pixels("é").eq(pixels("?")));
    }
}
