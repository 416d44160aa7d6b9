//! The standard colours by name.
//!
//! The names and values of X11, and those that only POV-Ray's table has (`SummerSky`, `LightWood`
//! …), which the published datasets use; where both have a name, X11's value counts.
//! `Gray0` … `Gray100` (or `Grey`) are per cents of white. Case does not matter.

/// Finds a colour by its name: red, green and blue, each in [0, 1].
#[must_use]
pub fn find(name: &str) -> Option<[f32; 3]> {
    if let Some(percent) = gray(name) {
        // X11 rounds to whole 255ths, and so do its tables.
        let level = (f32::from(percent) * 2.55 + 0.5).floor() / 255.0;
        return Some([level; 3]);
    }
    let index = COLOURS
        .binary_search_by(|(known, _)| {
            let known = known.bytes().map(|b| b.to_ascii_lowercase());
            known.cmp(name.bytes().map(|b| b.to_ascii_lowercase()))
        })
        .ok()?;
    let code = COLOURS[index].1;
    Some([16, 8, 0].map(|shift| ((code >> shift) & 0xff) as f32 / 255.0))
}

/// Returns the names of all colours but the numbered grays, in the order of the alphabet.
pub fn names() -> impl Iterator<Item = &'static str> {
    COLOURS.iter().map(|(name, _)| *name)
}

/// Finds the name of a colour, if a name has exactly this value.
#[must_use]
pub fn name_of(colour: [f32; 3]) -> Option<&'static str> {
    names().find(|name| find(name) == Some(colour))
}

/// Returns the number N of `GrayN`.
fn gray(name: &str) -> Option<u8> {
    let (word, digits) = name.split_at_checked(4)?;
    if !word.eq_ignore_ascii_case("gray") && !word.eq_ignore_ascii_case("grey") {
        return None;
    }
    if !digits.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    digits.parse().ok().filter(|percent| *percent <= 100)
}

/// Sorted by name without regard to case.
#[rustfmt::skip]
static COLOURS: &[(&str, u32)] = &[
    ("AliceBlue", 0xf0f8ff), ("AntiqueWhite", 0xfaebd7), ("AntiqueWhite1", 0xffefdb),
    ("AntiqueWhite2", 0xeedfcc), ("AntiqueWhite3", 0xcdc0b0), ("AntiqueWhite4", 0x8b8378),
    ("Aquamarine", 0x7fffd4), ("Aquamarine1", 0x7fffd4), ("Aquamarine2", 0x76eec6),
    ("Aquamarine3", 0x66cdaa), ("Aquamarine4", 0x458b74), ("Azure", 0xf0ffff), ("Azure1", 0xf0ffff),
    ("Azure2", 0xe0eeee), ("Azure3", 0xc1cdcd), ("Azure4", 0x838b8b), ("BakersChoc", 0x5c3317),
    ("Beige", 0xf5f5dc), ("Bisque", 0xffe4c4), ("Bisque1", 0xffe4c4), ("Bisque2", 0xeed5b7),
    ("Bisque3", 0xcdb79e), ("Bisque4", 0x8b7d6b), ("Black", 0x000000), ("BlanchedAlmond", 0xffebcd),
    ("Blue", 0x0000ff), ("Blue1", 0x0000ff), ("Blue2", 0x0000ee), ("Blue3", 0x0000cd),
    ("Blue4", 0x00008b), ("BlueViolet", 0x8a2be2), ("Brass", 0xb5a642), ("BrightGold", 0xd9d91a),
    ("Bronze", 0x8c7824), ("Bronze2", 0xa67d3d), ("Brown", 0xa52a2a), ("Brown1", 0xff4040),
    ("Brown2", 0xee3b3b), ("Brown3", 0xcd3333), ("Brown4", 0x8b2323), ("Burlywood", 0xdeb887),
    ("Burlywood1", 0xffd39b), ("Burlywood2", 0xeec591), ("Burlywood3", 0xcdaa7d),
    ("Burlywood4", 0x8b7355), ("CadetBlue", 0x5f9ea0), ("CadetBlue1", 0x98f5ff),
    ("CadetBlue2", 0x8ee5ee), ("CadetBlue3", 0x7ac5cd), ("CadetBlue4", 0x53868b),
    ("Chartreuse", 0x7fff00), ("Chartreuse1", 0x7fff00), ("Chartreuse2", 0x76ee00),
    ("Chartreuse3", 0x66cd00), ("Chartreuse4", 0x458b00), ("Chocolate", 0xd2691e),
    ("Chocolate1", 0xff7f24), ("Chocolate2", 0xee7621), ("Chocolate3", 0xcd661d),
    ("Chocolate4", 0x8b4513), ("CoolCopper", 0xd9871a), ("Copper", 0xb87333), ("Coral", 0xff7f50),
    ("Coral1", 0xff7256), ("Coral2", 0xee6a50), ("Coral3", 0xcd5b45), ("Coral4", 0x8b3e2f),
    ("CornflowerBlue", 0x6495ed), ("Cornsilk", 0xfff8dc), ("Cornsilk1", 0xfff8dc),
    ("Cornsilk2", 0xeee8cd), ("Cornsilk3", 0xcdc8b1), ("Cornsilk4", 0x8b8878), ("Cyan", 0x00ffff),
    ("Cyan1", 0x00ffff), ("Cyan2", 0x00eeee), ("Cyan3", 0x00cdcd), ("Cyan4", 0x008b8b),
    ("DarkBlue", 0x00008b), ("DarkBrown", 0x5c4033), ("DarkCyan", 0x008b8b),
    ("DarkGoldenrod", 0xb8860b), ("DarkGoldenrod1", 0xffb90f), ("DarkGoldenrod2", 0xeead0e),
    ("DarkGoldenrod3", 0xcd950c), ("DarkGoldenrod4", 0x8b6508), ("DarkGray", 0xa9a9a9),
    ("DarkGreen", 0x006400), ("DarkGrey", 0xa9a9a9), ("DarkKhaki", 0xbdb76b),
    ("DarkMagenta", 0x8b008b), ("DarkOliveGreen", 0x556b2f), ("DarkOliveGreen1", 0xcaff70),
    ("DarkOliveGreen2", 0xbcee68), ("DarkOliveGreen3", 0xa2cd5a), ("DarkOliveGreen4", 0x6e8b3d),
    ("DarkOrange", 0xff8c00), ("DarkOrange1", 0xff7f00), ("DarkOrange2", 0xee7600),
    ("DarkOrange3", 0xcd6600), ("DarkOrange4", 0x8b4500), ("DarkOrchid", 0x9932cc),
    ("DarkOrchid1", 0xbf3eff), ("DarkOrchid2", 0xb23aee), ("DarkOrchid3", 0x9a32cd),
    ("DarkOrchid4", 0x68228b), ("DarkPurple", 0x871f78), ("DarkRed", 0x8b0000),
    ("DarkSalmon", 0xe9967a), ("DarkSeaGreen", 0x8fbc8f), ("DarkSeaGreen1", 0xc1ffc1),
    ("DarkSeaGreen2", 0xb4eeb4), ("DarkSeaGreen3", 0x9bcd9b), ("DarkSeaGreen4", 0x698b69),
    ("DarkSlateBlue", 0x483d8b), ("DarkSlateGray", 0x2f4f4f), ("DarkSlateGray1", 0x97ffff),
    ("DarkSlateGray2", 0x8deeee), ("DarkSlateGray3", 0x79cdcd), ("DarkSlateGray4", 0x528b8b),
    ("DarkSlateGrey", 0x2f4f4f), ("DarkTan", 0x96694f), ("DarkTurquoise", 0x00ced1),
    ("DarkViolet", 0x9400d3), ("DarkWood", 0x855e42), ("DebianRed", 0xd70751),
    ("DeepPink", 0xff1493), ("DeepPink1", 0xff1493), ("DeepPink2", 0xee1289),
    ("DeepPink3", 0xcd1076), ("DeepPink4", 0x8b0a50), ("DeepSkyBlue", 0x00bfff),
    ("DeepSkyBlue1", 0x00bfff), ("DeepSkyBlue2", 0x00b2ee), ("DeepSkyBlue3", 0x009acd),
    ("DeepSkyBlue4", 0x00688b), ("DimGray", 0x696969), ("DimGrey", 0x696969),
    ("DkGreenCopper", 0x4a756e), ("DodgerBlue", 0x1e90ff), ("DodgerBlue1", 0x1e90ff),
    ("DodgerBlue2", 0x1c86ee), ("DodgerBlue3", 0x1874cd), ("DodgerBlue4", 0x104e8b),
    ("DustyRose", 0x856363), ("Feldspar", 0xd19175), ("Firebrick", 0xb22222),
    ("Firebrick1", 0xff3030), ("Firebrick2", 0xee2c2c), ("Firebrick3", 0xcd2626),
    ("Firebrick4", 0x8b1a1a), ("Flesh", 0xf5ccb0), ("FloralWhite", 0xfffaf0),
    ("ForestGreen", 0x228b22), ("Gainsboro", 0xdcdcdc), ("GhostWhite", 0xf8f8ff),
    ("Gold", 0xffd700), ("Gold1", 0xffd700), ("Gold2", 0xeec900), ("Gold3", 0xcdad00),
    ("Gold4", 0x8b7500), ("Goldenrod", 0xdaa520), ("Goldenrod1", 0xffc125),
    ("Goldenrod2", 0xeeb422), ("Goldenrod3", 0xcd9b1d), ("Goldenrod4", 0x8b6914),
    ("Gray", 0xbebebe), ("Green", 0x00ff00), ("Green1", 0x00ff00), ("Green2", 0x00ee00),
    ("Green3", 0x00cd00), ("Green4", 0x008b00), ("GreenCopper", 0x527d75),
    ("GreenYellow", 0xadff2f), ("Grey", 0xbebebe), ("Honeydew", 0xf0fff0), ("Honeydew1", 0xf0fff0),
    ("Honeydew2", 0xe0eee0), ("Honeydew3", 0xc1cdc1), ("Honeydew4", 0x838b83),
    ("HotPink", 0xff69b4), ("HotPink1", 0xff6eb4), ("HotPink2", 0xee6aa7), ("HotPink3", 0xcd6090),
    ("HotPink4", 0x8b3a62), ("HuntersGreen", 0x215e4f), ("IndianRed", 0xcd5c5c),
    ("IndianRed1", 0xff6a6a), ("IndianRed2", 0xee6363), ("IndianRed3", 0xcd5555),
    ("IndianRed4", 0x8b3a3a), ("Ivory", 0xfffff0), ("Ivory1", 0xfffff0), ("Ivory2", 0xeeeee0),
    ("Ivory3", 0xcdcdc1), ("Ivory4", 0x8b8b83), ("Khaki", 0xf0e68c), ("Khaki1", 0xfff68f),
    ("Khaki2", 0xeee685), ("Khaki3", 0xcdc673), ("Khaki4", 0x8b864e), ("Lavender", 0xe6e6fa),
    ("LavenderBlush", 0xfff0f5), ("LavenderBlush1", 0xfff0f5), ("LavenderBlush2", 0xeee0e5),
    ("LavenderBlush3", 0xcdc1c5), ("LavenderBlush4", 0x8b8386), ("LawnGreen", 0x7cfc00),
    ("LemonChiffon", 0xfffacd), ("LemonChiffon1", 0xfffacd), ("LemonChiffon2", 0xeee9bf),
    ("LemonChiffon3", 0xcdc9a5), ("LemonChiffon4", 0x8b8970), ("Light_Purple", 0xde94fa),
    ("LightBlue", 0xadd8e6), ("LightBlue1", 0xbfefff), ("LightBlue2", 0xb2dfee),
    ("LightBlue3", 0x9ac0cd), ("LightBlue4", 0x68838b), ("LightCoral", 0xf08080),
    ("LightCyan", 0xe0ffff), ("LightCyan1", 0xe0ffff), ("LightCyan2", 0xd1eeee),
    ("LightCyan3", 0xb4cdcd), ("LightCyan4", 0x7a8b8b), ("LightGoldenrod", 0xeedd82),
    ("LightGoldenrod1", 0xffec8b), ("LightGoldenrod2", 0xeedc82), ("LightGoldenrod3", 0xcdbe70),
    ("LightGoldenrod4", 0x8b814c), ("LightGoldenrodYellow", 0xfafad2), ("LightGray", 0xd3d3d3),
    ("LightGreen", 0x90ee90), ("LightGrey", 0xd3d3d3), ("LightPink", 0xffb6c1),
    ("LightPink1", 0xffaeb9), ("LightPink2", 0xeea2ad), ("LightPink3", 0xcd8c95),
    ("LightPink4", 0x8b5f65), ("LightSalmon", 0xffa07a), ("LightSalmon1", 0xffa07a),
    ("LightSalmon2", 0xee9572), ("LightSalmon3", 0xcd8162), ("LightSalmon4", 0x8b5742),
    ("LightSeaGreen", 0x20b2aa), ("LightSkyBlue", 0x87cefa), ("LightSkyBlue1", 0xb0e2ff),
    ("LightSkyBlue2", 0xa4d3ee), ("LightSkyBlue3", 0x8db6cd), ("LightSkyBlue4", 0x607b8b),
    ("LightSlateBlue", 0x8470ff), ("LightSlateGray", 0x778899), ("LightSlateGrey", 0x778899),
    ("LightSteelBlue", 0xb0c4de), ("LightSteelBlue1", 0xcae1ff), ("LightSteelBlue2", 0xbcd2ee),
    ("LightSteelBlue3", 0xa2b5cd), ("LightSteelBlue4", 0x6e7b8b), ("LightWood", 0xe8c2a6),
    ("LightYellow", 0xffffe0), ("LightYellow1", 0xffffe0), ("LightYellow2", 0xeeeed1),
    ("LightYellow3", 0xcdcdb4), ("LightYellow4", 0x8b8b7a), ("LimeGreen", 0x32cd32),
    ("Linen", 0xfaf0e6), ("Magenta", 0xff00ff), ("Magenta1", 0xff00ff), ("Magenta2", 0xee00ee),
    ("Magenta3", 0xcd00cd), ("Magenta4", 0x8b008b), ("MandarinOrange", 0xe37833),
    ("Maroon", 0xb03060), ("Maroon1", 0xff34b3), ("Maroon2", 0xee30a7), ("Maroon3", 0xcd2990),
    ("Maroon4", 0x8b1c62), ("Med_Purple", 0xba29f5), ("MediumAquamarine", 0x66cdaa),
    ("MediumBlue", 0x0000cd), ("MediumForestGreen", 0x6b8e23), ("MediumGoldenrod", 0xeaeaad),
    ("MediumOrchid", 0xba55d3), ("MediumOrchid1", 0xe066ff), ("MediumOrchid2", 0xd15fee),
    ("MediumOrchid3", 0xb452cd), ("MediumOrchid4", 0x7a378b), ("MediumPurple", 0x9370db),
    ("MediumPurple1", 0xab82ff), ("MediumPurple2", 0x9f79ee), ("MediumPurple3", 0x8968cd),
    ("MediumPurple4", 0x5d478b), ("MediumSeaGreen", 0x3cb371), ("MediumSlateBlue", 0x7b68ee),
    ("MediumSpringGreen", 0x00fa9a), ("MediumTurquoise", 0x48d1cc), ("MediumVioletRed", 0xc71585),
    ("MediumWood", 0xa68063), ("Mica", 0x000000), ("MidnightBlue", 0x191970),
    ("MintCream", 0xf5fffa), ("MistyRose", 0xffe4e1), ("MistyRose1", 0xffe4e1),
    ("MistyRose2", 0xeed5d2), ("MistyRose3", 0xcdb7b5), ("MistyRose4", 0x8b7d7b),
    ("Moccasin", 0xffe4b5), ("NavajoWhite", 0xffdead), ("NavajoWhite1", 0xffdead),
    ("NavajoWhite2", 0xeecfa1), ("NavajoWhite3", 0xcdb38b), ("NavajoWhite4", 0x8b795e),
    ("Navy", 0x000080), ("NavyBlue", 0x000080), ("NeonBlue", 0x4c4cff), ("NeonPink", 0xff6ec7),
    ("NewMidnightBlue", 0x00009c), ("NewTan", 0xebc79e), ("OldGold", 0xcfb53b),
    ("OldLace", 0xfdf5e6), ("OliveDrab", 0x6b8e23), ("OliveDrab1", 0xc0ff3e),
    ("OliveDrab2", 0xb3ee3a), ("OliveDrab3", 0x9acd32), ("OliveDrab4", 0x698b22),
    ("Orange", 0xffa500), ("Orange1", 0xffa500), ("Orange2", 0xee9a00), ("Orange3", 0xcd8500),
    ("Orange4", 0x8b5a00), ("OrangeRed", 0xff4500), ("OrangeRed1", 0xff4500),
    ("OrangeRed2", 0xee4000), ("OrangeRed3", 0xcd3700), ("OrangeRed4", 0x8b2500),
    ("Orchid", 0xda70d6), ("Orchid1", 0xff83fa), ("Orchid2", 0xee7ae9), ("Orchid3", 0xcd69c9),
    ("Orchid4", 0x8b4789), ("PaleGoldenrod", 0xeee8aa), ("PaleGreen", 0x98fb98),
    ("PaleGreen1", 0x9aff9a), ("PaleGreen2", 0x90ee90), ("PaleGreen3", 0x7ccd7c),
    ("PaleGreen4", 0x548b54), ("PaleTurquoise", 0xafeeee), ("PaleTurquoise1", 0xbbffff),
    ("PaleTurquoise2", 0xaeeeee), ("PaleTurquoise3", 0x96cdcd), ("PaleTurquoise4", 0x668b8b),
    ("PaleVioletRed", 0xdb7093), ("PaleVioletRed1", 0xff82ab), ("PaleVioletRed2", 0xee799f),
    ("PaleVioletRed3", 0xcd6889), ("PaleVioletRed4", 0x8b475d), ("PapayaWhip", 0xffefd5),
    ("PeachPuff", 0xffdab9), ("PeachPuff1", 0xffdab9), ("PeachPuff2", 0xeecbad),
    ("PeachPuff3", 0xcdaf95), ("PeachPuff4", 0x8b7765), ("Peru", 0xcd853f), ("Pink", 0xffc0cb),
    ("Pink1", 0xffb5c5), ("Pink2", 0xeea9b8), ("Pink3", 0xcd919e), ("Pink4", 0x8b636c),
    ("Plum", 0xdda0dd), ("Plum1", 0xffbbff), ("Plum2", 0xeeaeee), ("Plum3", 0xcd96cd),
    ("Plum4", 0x8b668b), ("PowderBlue", 0xb0e0e6), ("Purple", 0xa020f0), ("Purple1", 0x9b30ff),
    ("Purple2", 0x912cee), ("Purple3", 0x7d26cd), ("Purple4", 0x551a8b), ("Quartz", 0xd9d9f2),
    ("Red", 0xff0000), ("Red1", 0xff0000), ("Red2", 0xee0000), ("Red3", 0xcd0000),
    ("Red4", 0x8b0000), ("RichBlue", 0x5959ab), ("RosyBrown", 0xbc8f8f), ("RosyBrown1", 0xffc1c1),
    ("RosyBrown2", 0xeeb4b4), ("RosyBrown3", 0xcd9b9b), ("RosyBrown4", 0x8b6969),
    ("RoyalBlue", 0x4169e1), ("RoyalBlue1", 0x4876ff), ("RoyalBlue2", 0x436eee),
    ("RoyalBlue3", 0x3a5fcd), ("RoyalBlue4", 0x27408b), ("SaddleBrown", 0x8b4513),
    ("Salmon", 0xfa8072), ("Salmon1", 0xff8c69), ("Salmon2", 0xee8262), ("Salmon3", 0xcd7054),
    ("Salmon4", 0x8b4c39), ("SandyBrown", 0xf4a460), ("Scarlet", 0x8c1717), ("SeaGreen", 0x2e8b57),
    ("SeaGreen1", 0x54ff9f), ("SeaGreen2", 0x4eee94), ("SeaGreen3", 0x43cd80),
    ("SeaGreen4", 0x2e8b57), ("Seashell", 0xfff5ee), ("Seashell1", 0xfff5ee),
    ("Seashell2", 0xeee5de), ("Seashell3", 0xcdc5bf), ("Seashell4", 0x8b8682),
    ("SemiSweetChoc", 0x6b4226), ("Sienna", 0xa0522d), ("Sienna1", 0xff8247), ("Sienna2", 0xee7942),
    ("Sienna3", 0xcd6839), ("Sienna4", 0x8b4726), ("Silver", 0xe6e8fa), ("SkyBlue", 0x87ceeb),
    ("SkyBlue1", 0x87ceff), ("SkyBlue2", 0x7ec0ee), ("SkyBlue3", 0x6ca6cd), ("SkyBlue4", 0x4a708b),
    ("SlateBlue", 0x6a5acd), ("SlateBlue1", 0x836fff), ("SlateBlue2", 0x7a67ee),
    ("SlateBlue3", 0x6959cd), ("SlateBlue4", 0x473c8b), ("SlateGray", 0x708090),
    ("SlateGray1", 0xc6e2ff), ("SlateGray2", 0xb9d3ee), ("SlateGray3", 0x9fb6cd),
    ("SlateGray4", 0x6c7b8b), ("SlateGrey", 0x708090), ("Snow", 0xfffafa), ("Snow1", 0xfffafa),
    ("Snow2", 0xeee9e9), ("Snow3", 0xcdc9c9), ("Snow4", 0x8b8989), ("SpicyPink", 0xff1cad),
    ("SpringGreen", 0x00ff7f), ("SpringGreen1", 0x00ff7f), ("SpringGreen2", 0x00ee76),
    ("SpringGreen3", 0x00cd66), ("SpringGreen4", 0x008b45), ("SteelBlue", 0x4682b4),
    ("SteelBlue1", 0x63b8ff), ("SteelBlue2", 0x5cacee), ("SteelBlue3", 0x4f94cd),
    ("SteelBlue4", 0x36648b), ("SummerSky", 0x38b0de), ("Tan", 0xd2b48c), ("Tan1", 0xffa54f),
    ("Tan2", 0xee9a49), ("Tan3", 0xcd853f), ("Tan4", 0x8b5a2b), ("Thistle", 0xd8bfd8),
    ("Thistle1", 0xffe1ff), ("Thistle2", 0xeed2ee), ("Thistle3", 0xcdb5cd), ("Thistle4", 0x8b7b8b),
    ("Tomato", 0xff6347), ("Tomato1", 0xff6347), ("Tomato2", 0xee5c42), ("Tomato3", 0xcd4f39),
    ("Tomato4", 0x8b3626), ("Turquoise", 0x40e0d0), ("Turquoise1", 0x00f5ff),
    ("Turquoise2", 0x00e5ee), ("Turquoise3", 0x00c5cd), ("Turquoise4", 0x00868b),
    ("Very_Light_Purple", 0xf0cffc), ("VeryDarkBrown", 0x592924), ("Violet", 0xee82ee),
    ("VioletRed", 0xd02090), ("VioletRed1", 0xff3e96), ("VioletRed2", 0xee3a8c),
    ("VioletRed3", 0xcd3278), ("VioletRed4", 0x8b2252), ("VLightGray", 0xcccccc),
    ("Wheat", 0xf5deb3), ("Wheat1", 0xffe7ba), ("Wheat2", 0xeed8ae), ("Wheat3", 0xcdba96),
    ("Wheat4", 0x8b7e66), ("White", 0xffffff), ("WhiteSmoke", 0xf5f5f5), ("Yellow", 0xffff00),
    ("Yellow1", 0xffff00), ("Yellow2", 0xeeee00), ("Yellow3", 0xcdcd00), ("Yellow4", 0x8b8b00),
    ("YellowGreen", 0x9acd32),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_order_and_are_found() {
        for pair in COLOURS.windows(2) {
            assert!(
                pair[0].0.to_lowercase() < pair[1].0.to_lowercase(),
                "{pair:?}"
            );
        }
        for name in names() {
            assert!(find(name).is_some(), "{name}");
            assert_eq!(find(name), find(&name.to_uppercase()), "{name}");
        }
    }

    #[test]
    fn values() {
        assert_eq!(code("OrangeRed"), Some([255, 69, 0]));
        assert_eq!(code("orangered"), Some([255, 69, 0]));
        assert_eq!(code("DarkRed"), Some([139, 0, 0]));
        assert_eq!(code("SummerSky"), Some([56, 176, 222]));
        assert_eq!(code("Gold"), Some([255, 215, 0]));
        assert_eq!(code("Gray15"), Some([38, 38, 38]));
        assert_eq!(code("Grey100"), Some([255, 255, 255]));
        assert_eq!(code("Gray"), Some([190, 190, 190]));
        assert_eq!(code("LightWood"), Some([232, 194, 166]));
        assert_eq!(code("Gray101"), None);
        assert_eq!(code("Gray+5"), None);
        assert_eq!(code("nosuch"), None);
        assert_eq!(name_of([1.0, 0.0, 0.0]), Some("Red"));
    }

    fn code(name: &str) -> Option<[u8; 3]> {
        find(name).map(|c| c.map(|v| (v * 255.0).round() as u8))
    }
}
