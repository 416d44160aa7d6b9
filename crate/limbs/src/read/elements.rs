//! Elements: radii and colours.
//!
//! Van der Waals radii are Bondi's (J. Phys. Chem. 68, 1964), and for main-group elements that he
//! gives none for those of Mantina et al. (J. Phys. Chem. A 113, 2009). Covalent radii are those of
//! Cordero et al. (Dalton Trans. 2008), of carbon with single bonds, of manganese, iron and cobalt
//! with low spin. Colours are those of Jmol, after Corey, Pauling and Koltun.

/// Chemical element.
#[derive(Debug)]
pub(super) struct Element {
    /// Symbol.
    pub(super) symbol: &'static str,
    /// Van der Waals radius, ångström; `None` if there is none in the sources.
    pub(super) radius: Option<f64>,
    /// Covalent radius, ångström.
    pub(super) covalent: f64,
    /// Colour: red, green and blue of sRGB, eight bits each.
    pub(super) color: u32,
}

const fn element(symbol: &'static str, radius: Option<f64>, covalent: f64, color: u32) -> Element {
    Element {
        symbol,
        radius,
        covalent,
        color,
    }
}

/// The elements by their number, from hydrogen's 1 on.
#[rustfmt::skip]
pub(super) static ELEMENTS: [Element; 96] = [
    element("H", Some(1.2), 0.31, 0xFFFFFF),
    element("He", Some(1.4), 0.28, 0xD9FFFF),
    element("Li", Some(1.82), 1.28, 0xCC80FF),
    element("Be", Some(1.53), 0.96, 0xC2FF00),
    element("B", Some(1.92), 0.84, 0xFFB5B5),
    element("C", Some(1.7), 0.76, 0x909090),
    element("N", Some(1.55), 0.71, 0x3050F8),
    element("O", Some(1.52), 0.66, 0xFF0D0D),
    element("F", Some(1.47), 0.57, 0x90E050),
    element("Ne", Some(1.54), 0.58, 0xB3E3F5),
    element("Na", Some(2.27), 1.66, 0xAB5CF2),
    element("Mg", Some(1.73), 1.41, 0x8AFF00),
    element("Al", Some(1.84), 1.21, 0xBFA6A6),
    element("Si", Some(2.1), 1.11, 0xF0C8A0),
    element("P", Some(1.8), 1.07, 0xFF8000),
    element("S", Some(1.8), 1.05, 0xFFFF30),
    element("Cl", Some(1.75), 1.02, 0x1FF01F),
    element("Ar", Some(1.88), 1.06, 0x80D1E3),
    element("K", Some(2.75), 2.03, 0x8F40D4),
    element("Ca", Some(2.31), 1.76, 0x3DFF00),
    element("Sc", None, 1.7, 0xE6E6E6),
    element("Ti", None, 1.6, 0xBFC2C7),
    element("V", None, 1.53, 0xA6A6AB),
    element("Cr", None, 1.39, 0x8A99C7),
    element("Mn", None, 1.39, 0x9C7AC7),
    element("Fe", None, 1.32, 0xE06633),
    element("Co", None, 1.26, 0xF090A0),
    element("Ni", Some(1.63), 1.24, 0x50D050),
    element("Cu", Some(1.4), 1.32, 0xC88033),
    element("Zn", Some(1.39), 1.22, 0x7D80B0),
    element("Ga", Some(1.87), 1.22, 0xC28F8F),
    element("Ge", Some(2.11), 1.2, 0x668F8F),
    element("As", Some(1.85), 1.19, 0xBD80E3),
    element("Se", Some(1.9), 1.2, 0xFFA100),
    element("Br", Some(1.85), 1.2, 0xA62929),
    element("Kr", Some(2.02), 1.16, 0x5CB8D1),
    element("Rb", Some(3.03), 2.2, 0x702EB0),
    element("Sr", Some(2.49), 1.95, 0x00FF00),
    element("Y", None, 1.9, 0x94FFFF),
    element("Zr", None, 1.75, 0x94E0E0),
    element("Nb", None, 1.64, 0x73C2C9),
    element("Mo", None, 1.54, 0x54B5B5),
    element("Tc", None, 1.47, 0x3B9E9E),
    element("Ru", None, 1.46, 0x248F8F),
    element("Rh", None, 1.42, 0x0A7D8C),
    element("Pd", Some(1.63), 1.39, 0x006985),
    element("Ag", Some(1.72), 1.45, 0xC0C0C0),
    element("Cd", Some(1.58), 1.44, 0xFFD98F),
    element("In", Some(1.93), 1.42, 0xA67573),
    element("Sn", Some(2.17), 1.39, 0x668080),
    element("Sb", Some(2.06), 1.39, 0x9E63B5),
    element("Te", Some(2.06), 1.38, 0xD47A00),
    element("I", Some(1.98), 1.39, 0x940094),
    element("Xe", Some(2.16), 1.4, 0x429EB0),
    element("Cs", Some(3.43), 2.44, 0x57178F),
    element("Ba", Some(2.68), 2.15, 0x00C900),
    element("La", None, 2.07, 0x70D4FF),
    element("Ce", None, 2.04, 0xFFFFC7),
    element("Pr", None, 2.03, 0xD9FFC7),
    element("Nd", None, 2.01, 0xC7FFC7),
    element("Pm", None, 1.99, 0xA3FFC7),
    element("Sm", None, 1.98, 0x8FFFC7),
    element("Eu", None, 1.98, 0x61FFC7),
    element("Gd", None, 1.96, 0x45FFC7),
    element("Tb", None, 1.94, 0x30FFC7),
    element("Dy", None, 1.92, 0x1FFFC7),
    element("Ho", None, 1.92, 0x00FF9C),
    element("Er", None, 1.89, 0x00E675),
    element("Tm", None, 1.9, 0x00D452),
    element("Yb", None, 1.87, 0x00BF38),
    element("Lu", None, 1.87, 0x00AB24),
    element("Hf", None, 1.75, 0x4DC2FF),
    element("Ta", None, 1.7, 0x4DA6FF),
    element("W", None, 1.62, 0x2194D6),
    element("Re", None, 1.51, 0x267DAB),
    element("Os", None, 1.44, 0x266696),
    element("Ir", None, 1.41, 0x175487),
    element("Pt", Some(1.75), 1.36, 0xD0D0E0),
    element("Au", Some(1.66), 1.36, 0xFFD123),
    element("Hg", Some(1.55), 1.32, 0xB8B8D0),
    element("Tl", Some(1.96), 1.45, 0xA6544D),
    element("Pb", Some(2.02), 1.46, 0x575961),
    element("Bi", Some(2.07), 1.48, 0x9E4FB5),
    element("Po", Some(1.97), 1.4, 0xAB5C00),
    element("At", Some(2.02), 1.5, 0x754F45),
    element("Rn", Some(2.2), 1.5, 0x428296),
    element("Fr", Some(3.48), 2.6, 0x420066),
    element("Ra", Some(2.83), 2.21, 0x007D00),
    element("Ac", None, 2.15, 0x70ABFA),
    element("Th", None, 2.06, 0x00BAFF),
    element("Pa", None, 2.0, 0x00A1FF),
    element("U", Some(1.86), 1.96, 0x008FFF),
    element("Np", None, 1.9, 0x0080FF),
    element("Pu", None, 1.87, 0x006BFF),
    element("Am", None, 1.8, 0x545CF2),
    element("Cm", None, 1.69, 0x785CE3),
];
